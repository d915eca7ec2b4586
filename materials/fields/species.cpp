#include "materials/fields/species.hpp"

#include <algorithm>
#include <map>
#include <mutex>

#include "materials/fields/k_distribution.hpp"
#include "sim/parameters/csv_table.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

constexpr double kShortest_um = 0.3, kLongest_um = 30.0;
constexpr std::uintmax_t kMostBytes = 4u << 20;  ///< a hundred times the largest of the library's
constexpr std::size_t kMostRows = 20000;
constexpr double kHottest_K = 1e5;

struct Named {
  const char *file, *name, *unit;
  bool gas;
  BandAbsorber absorber;
};

const Named& named(Species species) {
  static const Named all[] = {{"co2.csv", "carbon dioxide", "1/(atm m)", true, BandAbsorber::CarbonDioxide},
                              {"h2o.csv", "water vapour", "1/(atm m)", true, BandAbsorber::WaterVapour},
                              {"co.csv", "carbon monoxide", "1/(atm m)", true, BandAbsorber::CarbonMonoxide},
                              {"soot.csv", "soot", "1/m", false, BandAbsorber::CarbonDioxide},
                              {"alumina.csv", "alumina", "m2/kg", false, BandAbsorber::CarbonDioxide}};
  return all[static_cast<std::size_t>(species)];
}

FileWanted wanted() { return {"a table of a species", kMostBytes, "check the library's folder 'gases'", "thin the table out"}; }

/// A constant in each of adjoining ranges: a step takes two rows, ranges of the same value none.
class Steps {
 public:
  void add(double to_um, double value) {
    to_um = std::min(to_um, kLongest_um);
    if (to_um <= at_) return;
    if (value != value_ || table_.value.empty()) {
      if (!table_.value.empty()) push(value_);
      push(value);
      value_ = value;
    }
    at_ = to_um;
  }
  Spectrum close(const std::string& name) {
    add(kLongest_um, 0.0);
    push(value_);
    table_.name = name;
    return Spectrum(std::move(table_));
  }

 private:
  void push(double value) {
    table_.wavelength_um.push_back(at_);
    table_.value.push_back(value);
  }
  Spectrum::Table table_;
  double at_ = kShortest_um, value_ = -1.0;
};

class Reader {
 public:
  Reader(Species species, const std::filesystem::path& file, const Location& askedAt)
      : named_(named(species)), csv_(readCsvTable(file, wanted(), kMostRows, askedAt)) {
    table_.name = named_.name;
    table_.source = commentsOf(readWholeFile(file, wanted(), askedAt));
  }

  SpeciesTable read() {
    if (csv_.rows() == 0) throw UserError({csv_.file, 1, 1, -1}, "the table of " + table_.name + " has no rows", "at least one", "add rows");
    if (named_.gas) readGas();
    else readParticles();
    return std::move(table_);
  }

 private:
  static std::string commentsOf(const std::string& bytes) {
    std::string all;
    for (std::size_t begin = 0; begin < bytes.size() && bytes[begin] == '#';) {
      const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
      const std::size_t first = std::min(bytes.find_first_not_of("# ", begin), end);
      all += (all.empty() ? "" : " ") + bytes.substr(first, end - first);
      begin = end + 1;
    }
    return all;
  }

  void wantColumn(std::size_t column, const std::string& name, const std::string& unit) const {
    const std::string whole = name + " [" + unit + "]";
    if (column >= csv_.columns.size())
      throw UserError({csv_.file, csv_.lines.front(), 1, -1}, "the table of " + table_.name + " ends before column '" + whole + "'", "that column", "add it");
    if (csv_.columns[column].name != name || csv_.columns[column].unit != unit)
      throw UserError(csv_.columns[column].where,
                      "column " + std::to_string(column + 1) + " is '" + csv_.columns[column].name + " [" + csv_.columns[column].unit + "]'", "'" + whole + "'",
                      "correct the header");
  }

  /// Columns "<what> <temperature> K" from `first` on, as far as they go.
  std::vector<double> levels(std::size_t first, const std::string& what, const std::string& unit) const {
    std::vector<double> all;
    for (std::size_t c = first; c < csv_.columns.size() && csv_.columns[c].name.rfind(what + " ", 0) == 0; ++c) {
      const auto& column = csv_.columns[c];
      const auto level = splitQuantity(column.name.substr(what.size() + 1));
      if (!level || level->unit != "K" || column.unit != unit || !(level->value > (all.empty() ? 0.0 : all.back())) || level->value > kHottest_K)
        throw UserError(column.where, "column '" + column.name + " [" + column.unit + "]' is not a level of temperature above the one before",
                        "'" + what + " <temperature> K [" + unit + "]', rising", "correct the header");
      all.push_back(level->value);
    }
    if (all.empty()) wantColumn(first, what + " 300 K", unit);
    return all;
  }

  double atLeast(double least, std::size_t row, std::size_t column) const {
    const double value = csv_.at(row, column);
    if (!(value >= least))
      throw UserError(csv_.whereOf(row), "'" + csv_.columns[column].name + "' is " + std::to_string(value), "at least " + std::to_string(least),
                      "correct the row");
    return value;
  }

  void wantEnd(std::size_t columns) const {
    if (csv_.columns.size() > columns)
      throw UserError(csv_.columns[columns].where, "the table of " + table_.name + " has a column too many: '" + csv_.columns[columns].name + "'",
                      std::to_string(columns) + " columns", "remove it");
  }

  void readGas() {
    wantColumn(0, "from", "1/cm");
    wantColumn(1, "to", "1/cm");
    wantColumn(2, "cells", "1");
    table_.temperature_K = levels(3, "mean", named_.unit);
    const std::size_t count = table_.temperature_K.size();
    if (levels(3 + count, "overlap", "1") != table_.temperature_K)
      throw UserError(csv_.columns[3 + count].where, "'overlap' has other levels of temperature than 'mean'", "the same", "correct the header");
    wantEnd(3 + 2 * count);
    for (std::size_t row = 0; row < csv_.rows(); ++row) {
      SpeciesBand band{csv_.at(row, 0), csv_.at(row, 1), 1, {}, {}};
      if (!(band.low_per_cm > 0.0 && band.high_per_cm > band.low_per_cm) || (row > 0 && band.low_per_cm < table_.bands.back().high_per_cm))
        throw UserError(csv_.whereOf(row), "bands overlap or do not rise", "each from where the one before ends or later, its end above its begin",
                        "sort the rows");
      const double cells = csv_.at(row, 2);
      if (!(cells >= 1.0 && cells <= 100.0 && isCellCount(static_cast<std::size_t>(cells))))
        throw UserError(csv_.whereOf(row), "a band of " + std::to_string(cells) + " cells", "1, 6, 8 or 12", "correct the row");
      band.cells = static_cast<std::size_t>(cells);
      for (std::size_t l = 0; l < count; ++l) {
        band.mean_per_atm_m.push_back(atLeast(0.0, row, 3 + l));
        band.overlap.push_back(atLeast(1e-4, row, 3 + count + l));
      }
      table_.bands.push_back(std::move(band));
    }
    for (std::size_t l = 0; l < count; ++l) table_.absorption.push_back(laidOut(l));
  }

  Spectrum laidOut(std::size_t level) const {
    Steps steps;
    for (std::size_t i = table_.bands.size(); i-- > 0;) {
      const SpeciesBand& band = table_.bands[i];
      const double from_um = 1e4 / band.high_per_cm, to_um = 1e4 / band.low_per_cm;
      steps.add(from_um, 0.0);  // the gap before it
      const auto shares = cellShares(band.cells);
      const auto absorption = cellAbsorption(band.cells, named_.absorber, band.overlap[level]);
      double share = 0.0;
      for (std::size_t c = 0; c < band.cells; ++c) {
        share += shares[c];
        steps.add(c + 1 == band.cells ? to_um : from_um + share * (to_um - from_um), band.mean_per_atm_m[level] * absorption[c]);
      }
    }
    return steps.close(csv_.file);
  }

  void readParticles() {
    wantColumn(0, "wavelength", "um");
    table_.temperature_K = levels(1, "absorption", named_.unit);
    wantEnd(1 + table_.temperature_K.size());
    std::vector<double> wavelength_um;
    for (std::size_t row = 0; row < csv_.rows(); ++row) {
      wavelength_um.push_back(atLeast(kShortestWavelength_um, row, 0));
      if (row > 0 && wavelength_um[row] <= wavelength_um[row - 1])
        throw UserError(csv_.whereOf(row), "the wavelengths do not rise", "each above the one before", "sort the rows");
    }
    for (std::size_t l = 0; l < table_.temperature_K.size(); ++l) {
      Spectrum::Table values{wavelength_um, {}, Outside::Error, csv_.file};
      for (std::size_t row = 0; row < csv_.rows(); ++row) values.value.push_back(atLeast(0.0, row, 1 + l));
      table_.absorption.emplace_back(std::move(values));
    }
  }

  const Named& named_;
  CsvTable csv_;
  SpeciesTable table_;
};

}  // namespace

SpeciesTable readSpeciesTable(Species species, const std::filesystem::path& file, const Location& askedAt) { return Reader(species, file, askedAt).read(); }

const SpeciesTable& speciesTable(Species species, const std::filesystem::path& libraryFolder) {
  static std::mutex mutex;
  static std::map<std::filesystem::path, SpeciesTable> all;  // references into a map stay valid
  const std::filesystem::path file = libraryFolder / "gases" / named(species).file;
  const std::lock_guard lock(mutex);
  const auto found = all.find(file);
  return found != all.end() ? found->second : all.emplace(file, readSpeciesTable(species, file)).first->second;
}

BetweenLevels betweenLevels(const SpeciesTable& table, double temperature_K) {
  const auto& t = table.temperature_K;
  if (t.size() == 1 || !(temperature_K > t.front())) return {};
  if (temperature_K >= t.back()) return {t.size() - 2, 1.0};
  const std::size_t lower = static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), temperature_K) - t.begin()) - 1;
  return {lower, (temperature_K - t[lower]) / (t[lower + 1] - t[lower])};
}

double absorptionOf(const SpeciesTable& table, double wavelength_um, double temperature_K) {
  const BetweenLevels at = betweenLevels(table, temperature_K);
  const double low = table.absorption[at.lower](wavelength_um);
  return at.part == 0.0 ? low : low + at.part * (table.absorption[at.lower + 1](wavelength_um) - low);
}

}  // namespace pitviper
