#include "atmosphere/csv_rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "atmosphere/depth_fit.hpp"
#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper::csv {
namespace {

constexpr std::array<double, 3> kFittedPowers = {0.55, 0.75, 1.0};
// Below it a transmittance says "opaque": measured ones end long before.
constexpr double kResolution = 1e-6;
// Six digits of text times the scale of a column.
constexpr double kRounding = 1e-6;
// Longer than any honest file: bounds the memory a broken one can take.
constexpr size_t kMostRows = 500000;

}  // namespace

void Rows::fail(int column, const std::string& wrong, const std::string& expected, const std::string& fix, int line) const {
  throw UserError({file_, line > 0 ? line : std::max(line_, 1), column, -1}, wrong, expected, fix);
}

double Rows::value(const Cell& cell, const Column& column, double low, double high) const {
  double v = 0.0;
  std::string_view text = cell.text;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  const std::string what = tokenOf(cell.text) + " for " + column.name;
  if (cell.text.empty()) fail(cell.column, "nothing stands for " + column.name, "a number in every cell", "fill it in, or remove the row");
  if (end != text.data() + text.size() || text.empty()) fail(cell.column, what + " is not a number", "a number such as 0.93 or 1.2e-3", "correct the cell");
  if (error != std::errc() || !std::isfinite(v)) fail(cell.column, what + " is not finite", "a number such as 0.93 or 1.2e-3", "correct the cell");
  v *= column.scale;
  if (v > high && v <= high * (1.0 + kRounding)) v = high;
  if (!(v >= low && v <= high))
    fail(cell.column, what + " is out of range", "a number from " + briefNumber(low / column.scale) + " to " + briefNumber(high / column.scale),
         column.meaning == Meaning::Transmittance ? "give transmittance as a fraction, not in per cent" : "correct the cell or its unit");
  return v;
}

double Rows::spectral(const Cell& cell, const Column& column) const {
  if (column.meaning == Meaning::Wavelength) return value(cell, column, kShortestWavelength_um, kLongestWavelength_um);
  return 1e4 / value(cell, column, 1e4 / kLongestWavelength_um, 1e4 / kShortestWavelength_um);
}

void Rows::add(std::span<const Cell> cells, int line, int width) {
  line_ = line;
  if (cells.size() != columns_.size())
    fail(cells.size() > columns_.size() ? cells[columns_.size()].column : width + 1, "a row of " + std::to_string(cells.size()) + " cells",
         std::to_string(columns_.size()) + (header_ > 0 ? ", as line " + std::to_string(header_) + " has names" : ", as many as there are names"),
         fixOfCells(cells.size(), columns_.size()));
  if (++rows_ > kMostRows) fail(1, "more than 500000 rows", "a table of air", "thin it out");

  double wavelength = 0.0, range = 0.0;
  const Column* axis = nullptr;
  int axisColumn = 1, rangeColumn = 1;
  for (size_t i = 0; i < cells.size(); ++i) {
    if (columns_[i].meaning == Meaning::Range) range = value(cells[i], columns_[i], 1e-6, 1e5), rangeColumn = cells[i].column;
    if (columns_[i].meaning != Meaning::Wavelength && columns_[i].meaning != Meaning::Wavenumber) continue;
    const double w = spectral(cells[i], columns_[i]);
    if (axis && std::abs(w / wavelength - 1.0) > 1e-4)
      fail(cells[i].column, columns_[i].name + " is not that of " + axis->name, "wavenumber = 10000 / wavelength in um", "correct one, or remove its column");
    if (!axis) wavelength = w, axis = &columns_[i], axisColumn = cells[i].column;
  }
  std::map<double, Entry> entries;
  double source = 0.0;
  for (size_t i = 0; i < cells.size(); ++i) {
    const Column& c = columns_[i];
    const double perUm = c.perWavenumber ? 1e8 / (wavelength * wavelength) : 1.0;  // W/(cm2 cm-1) to W/(m2 um): nu^2
    if (c.meaning == Meaning::Transmittance)
      entries[c.range_km.value_or(range)].transmittance = c.isDepth ? std::exp(-value(cells[i], c, 0.0, 1e9)) : value(cells[i], c, 0.0, 1.0);
    if (c.meaning == Meaning::Extinction) entries[0.0].transmittance = value(cells[i], c, 0.0, 1e9);
    if (c.meaning == Meaning::PathRadiance) {
      entries[c.range_km.value_or(range)].radiance = perUm * value(cells[i], c, 0.0, 1e30);
      seesRadiance_[c.range_km.value_or(range)] = true;
    }
    if (c.meaning == Meaning::SourceRadiance) source = perUm * value(cells[i], c, 0.0, 1e30);
  }
  for (auto& [at, entry] : entries) {
    entry.wavelength_um = wavelength;
    entry.line = line_;
    append(at, entry, source, *axis, axisColumn, rangeColumn);
  }
}

void Rows::append(double range, const Entry& entry, double source, const Column& axis, int axisColumn, int rangeColumn) {
  auto& list = table_[range];
  if (!list.empty()) {
    const double before = list.back().wavelength_um;
    const std::string over = hasColumn(Meaning::Range) ? " at a range of " + briefNumber(range) + " km" : "";
    if (entry.wavelength_um == before)
      fail(hasColumn(Meaning::Range) ? rangeColumn : axisColumn,
           "this " + std::string(axis.meaning == Meaning::Wavelength ? "wavelength" : "wavenumber") + over + " comes twice", "each once",
           "remove one of lines " + std::to_string(list.back().line) + " and " + std::to_string(entry.line));
    if ((entry.wavelength_um > before) != (axis.meaning == Meaning::Wavelength))
      fail(axisColumn, axis.name + " does not rise" + over, "more than in line " + std::to_string(list.back().line), "sort the rows");
  }
  list.push_back(entry);
  if (hasColumn(Meaning::SourceRadiance)) sources_[entry.wavelength_um] = source;
}

bool Rows::hasColumn(Meaning m) const {
  for (const Column& c : columns_)
    if (c.meaning == m) return true;
  return false;
}

void Rows::order() {
  if (table_.empty()) fail(1, "no rows", "two or more", "add rows below the names of columns");
  auto& first = table_.begin()->second;
  for (const auto& [range, list] : table_) {
    for (size_t i = 0; i < list.size(); ++i)
      if (i >= first.size() || list[i].wavelength_um != first[i].wavelength_um)
        fail(1, "a wavelength at a range of " + briefNumber(range) + " km that " + briefNumber(table_.begin()->first) + " km has not",
             "the same wavelengths for all ranges", "add or remove rows", list[i].line);
    if (list.size() < first.size())
      fail(1, "a wavelength at a range of " + briefNumber(table_.begin()->first) + " km that " + briefNumber(range) + " km has not",
           "the same wavelengths for all ranges", "add or remove rows", first[list.size()].line);
  }
  if (first.size() < 2) fail(1, "one wavelength", "two or more", "add rows: nothing is known between the wavelengths of one", first[0].line);
  if (first.front().wavelength_um > first.back().wavelength_um)
    for (auto& [range, list] : table_) std::reverse(list.begin(), list.end());
}

TabulatedAir Rows::make() {
  order();
  return hasColumn(Meaning::Extinction) ? fromExtinction() : fromTransmittance();
}

void Rows::join(Rows radiance) {
  order();
  radiance.order();
  // Wavelengths of one run, written with as many digits in both.
  constexpr double kSameWavelength = 1e-6;
  const auto& [range, own] = *table_.begin();
  const auto& other = radiance.table_.begin()->second;
  if (table_.size() != 1) fail(1, "several ranges beside a file of path radiance", "the range of both", "give columns of one range", header_);
  for (size_t i = 0; i < std::max(own.size(), other.size()); ++i)
    if (i >= own.size() || i >= other.size() || std::abs(other[i].wavelength_um / own[i].wavelength_um - 1.0) > kSameWavelength)
      radiance.fail(1, "the wavelengths of the path radiance are not those of " + file_, "one run's transmittance and radiance", "write both over one grid",
                    other[std::min(i, other.size() - 1)].line);
  for (size_t i = 0; i < other.size(); ++i) table_.begin()->second[i].radiance = other[i].radiance;
  seesRadiance_[range] = true;
}

TabulatedAir::Data Rows::begin() const {
  TabulatedAir::Data data;
  data.file = file_;
  data.line = header_;
  for (const Entry& e : table_.begin()->second) data.wavelength_um.push_back(e.wavelength_um);
  for (const auto& [wavelength, source] : sources_) data.sourceRadiance.push_back(source);
  return data;
}

TabulatedAir Rows::fromExtinction() const {
  TabulatedAir::Data data = begin();
  data.exponents = {1.0};
  for (const Entry& e : table_.begin()->second) data.depth.push_back({e.transmittance});
  data.description = "extinction by wavelength, exponential in range";
  return TabulatedAir(std::move(data));
}

TabulatedAir Rows::fromTransmittance() const {
  TabulatedAir::Data data = begin();
  if (table_.size() == 1) data.exponents = {1.0};
  else data.exponents.assign(kFittedPowers.begin(), kFittedPowers.end());
  data.shortest_m = 1e3 * table_.begin()->first;
  data.longest_m = 1e3 * table_.rbegin()->first;
  data.description = table_.size() == 1 ? "one range, " + briefNumber(table_.begin()->first) +
                                              " km; exponential in range, which it is not in bands of lines: other ranges are worse"
                                        : std::to_string(table_.size()) + " ranges, " + briefNumber(table_.begin()->first) + " to " +
                                              briefNumber(table_.rbegin()->first) + " km; powers of range fitted";
  double squares = 0.0;
  for (size_t i = 0; i < data.wavelength_um.size(); ++i) {
    std::vector<RangeDepth> rows;
    for (const auto& [range, list] : table_) {
      const double tau = list[i].transmittance;
      rows.push_back({range, tau, -std::log(std::max(tau, 0.5 * kResolution))});
    }
    DepthFit fit = fitDepth(rows, data.exponents, kResolution);
    data.fit.largest = std::max(data.fit.largest, fit.largest);
    squares += fit.sumOfSquares;
    data.depth.push_back(std::move(fit.coefficients));
  }
  data.fit.rms = std::sqrt(squares / static_cast<double>(data.wavelength_um.size() * table_.size()));
  if (!seesRadiance_.empty()) {
    std::vector<RangeRadiance> seen;
    for (const auto& [range, yes] : seesRadiance_) {
      seen.push_back({range, {}});
      for (const Entry& e : table_.at(range)) seen.back().radiance.push_back(e.radiance);
    }
    data.sourceRadiance = fitSource(data.depth, data.exponents, seen, data.fit.radiance);
  }
  return TabulatedAir(std::move(data));
}

}  // namespace pitviper::csv
