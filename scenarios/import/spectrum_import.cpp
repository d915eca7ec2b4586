#include "scenarios/import/spectrum_import.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/import/import_yaml.hpp"
#include "scenarios/import/jcamp.hpp"
#include "scenarios/import/number_lines.hpp"
#include "scenarios/import/spectrum_header.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/spectrum_value.hpp"

namespace pitviper {
namespace {

constexpr std::uintmax_t kLargestFile = 16u << 20;
/// h c / (e x 1 um) [eV um]. Source: CODATA 2018.
constexpr double kPhotonEnergy_eV_um = 1.239841984;
/// A channel that was taken out: the USGS writes -1.23e34.
constexpr double kDeleted = -1e30;
/// A reflectance against a standard may lie over 1 by tenths; noise about 0 is below it by less. What lies farther is in another unit.
constexpr double kMost = 1.5, kLeast = -0.5;
/// Two instruments that meet at one wavelength agree within so much, or one of them is wrong.
constexpr double kSamePlace = 0.02;

constexpr const char* kSayAxis = "say which by '--axis um', nm, angstrom, 1/cm or eV";
constexpr const char* kSayUnit = "say which by '--unit %' (0 to 100) or '--unit 1' (shares of 1)";

struct Point {
  double um, value;
  int line;
};

double micrometres(double x, SpectralAxis axis) {
  switch (axis) {
    case SpectralAxis::Nanometre:
      return x / 1e3;
    case SpectralAxis::Angstrom:
      return x / 1e4;
    case SpectralAxis::PerCentimetre:
      return 1e4 / x;
    case SpectralAxis::ElectronVolt:
      return kPhotonEnergy_eV_um / x;
    default:
      return x;
  }
}

const char* nameOf(SpectralAxis axis) {
  constexpr const char* names[] = {"um", "nm", "angstrom", "1/cm", "eV"};
  return names[static_cast<int>(axis)];
}
const char* nameOf(SpectrumQuantity q) {
  constexpr const char* names[] = {"reflectance", "transmittance", "emissivity"};
  return names[static_cast<int>(q)];
}

bool onSpectralAxis(double um) { return onAxis(um) >= kShortestWavelength_um && onAxis(um) <= kLongestWavelength_um; }

class Importer {
 public:
  Importer(const std::string& text, const std::filesystem::path& path, const ImportChoices& choices)
      : file_(path.string()), stem_(path.stem().string()), shown_(path.filename().string()), choices_(choices) {
    const std::string plain = asUtf8Lines(text, file_);
    data_ = isJcamp(plain) ? readJcamp(plain, file_) : readNumberLines(plain, file_);
  }

  ImportedMaterial run() {
    if (data_.rows.size() < 2)
      fail(1, "neither a material nor two columns of wavelength and reflectance below a head of words",
           "a YAML file, refractiveindex.info's YAML, or a spectrum of ECOSTRESS, the USGS or an instrument", "see 'pitviper material --help'");
    const std::size_t columns = data_.rows.front().values.size();
    if (choices_.column && (*choices_.column < 1 || static_cast<std::size_t>(*choices_.column) > columns))
      throw UserError({"--column " + std::to_string(*choices_.column), 0, 0, -1}, "the file has " + std::to_string(columns) + " columns",
                      "one of them, counted from 1", "correct the number");
    if (columns == 1) takeWavelengths();
    head_ = readSpectrumHeader(data_.head, data_.rows.front().values.size(), data_.style, choices_, file_);
    if (!head_.y)
      fail(data_.rows.front().line, std::to_string(columns) + " columns, of which none or several are named as a reflectance, a transmittance or an emissivity",
           "one of values", "say which by '--column N', counted from 1");
    const SpectrumQuantity quantity = quantityOf();
    const SpectralAxis axis = axisOf();
    if (data_.style == CellStyle::BlanksDecimalComma || data_.style == CellStyle::SemicolonsDecimalComma) note("commas are read as decimal points");
    std::vector<Point> points = pointsOf(axis);
    const double scale = scaleOf(points);
    for (Point& p : points) p.value = scale == 1.0 ? p.value : tidy(scale * p.value);
    points = ordered(std::move(points));
    if (points.size() > kMostSpectrumRows)
      fail(points[kMostSpectrumRows].line, "the spectrum goes on after " + std::to_string(kMostSpectrumRows) + " rows", "at most that many", "thin it out");
    bring(points, scale);
    return {yaml(points, quantity), notes_};
  }

 private:
  [[noreturn]] void fail(int line, const std::string& wrong, const std::string& expected, const std::string& fix) const {
    throw UserError({file_, std::max(line, 1), 1, -1}, wrong, expected, fix);
  }
  void note(const std::string& text) { notes_.push_back(readable(text)); }

  /// Of a file that the wavelengths of many spectra stand in.
  void takeWavelengths() {
    if (choices_.wavelengths.empty())
      fail(data_.rows.front().line, "one column: the values without their wavelengths",
           "a column of each, or the wavelengths in a file of their own, as the USGS's library 7 has them", "name that file by '--wavelengths FILE'");
    const std::string plain = asUtf8Lines(
        readWholeFile(choices_.wavelengths, {.what = "a file of wavelengths", .mostBytes = kLargestFile, .fix = "check the name"}), choices_.wavelengths);
    const NumberLines other = readNumberLines(plain, choices_.wavelengths);
    if (other.rows.empty() || other.rows.front().values.size() != 1)
      throw UserError({choices_.wavelengths, 1, 1, -1}, "no column of wavelengths", "one number to a line, as many as the spectrum has values",
                      "name the file that belongs to the spectrum's instrument");
    if (other.rows.size() != data_.rows.size())
      throw UserError({choices_.wavelengths, 1, 1, -1},
                      std::to_string(other.rows.size()) + " wavelengths for the " + std::to_string(data_.rows.size()) + " values of " + file_, "as many",
                      "name the file that belongs to the spectrum's instrument");
    data_.head.insert(data_.head.end(), other.head.begin(), other.head.end());
    for (std::size_t k = 0; k < data_.rows.size(); ++k) data_.rows[k].values.insert(data_.rows[k].values.begin(), other.rows[k].values[0]);
  }

  SpectrumQuantity quantityOf() const {
    if (choices_.quantity) return *choices_.quantity;
    if (head_.quantity) return head_.quantity->value;
    // The USGS's file names end so where their words do not.
    if (head_.sharesByCustom && (stem_.ends_with("AREF") || stem_.ends_with("RREF"))) return SpectrumQuantity::Reflectance;
    fail(data_.rows.front().line, "no word above the numbers says of what they are", "reflectance, transmittance or emissivity",
         "say which by '--quantity reflectance', transmittance or emissivity");
  }

  /// As said; by the instrument that is named, or by the one unit in which all lie on the spectral axis, where nothing is said.
  SpectralAxis axisOf() {
    const auto fits = [&](SpectralAxis axis) {
      return std::all_of(data_.rows.begin(), data_.rows.end(), [&](const NumberRow& r) { return onSpectralAxis(micrometres(r.values[head_.x], axis)); });
    };
    if (choices_.axis) return *choices_.axis;
    if (head_.axis && !head_.axisOfInstrument) return head_.axis->value;
    if (head_.axis && fits(head_.axis->value)) {
      note(std::string("the wavelengths' unit is not written: ") + nameOf(head_.axis->value) + ", as of what line " + std::to_string(head_.axis->line) +
           " names");
      return head_.axis->value;
    }
    std::vector<SpectralAxis> possible;
    for (SpectralAxis a : {SpectralAxis::Micrometre, SpectralAxis::Nanometre, SpectralAxis::Angstrom, SpectralAxis::PerCentimetre})
      if (fits(a) && !(head_.wavelengths && a == SpectralAxis::PerCentimetre)) possible.push_back(a);
    if (possible.size() != 1) {
      std::string all;
      for (SpectralAxis a : possible) all += (all.empty() ? "" : ", ") + std::string(nameOf(a));
      const auto [least, most] =
          std::minmax_element(data_.rows.begin(), data_.rows.end(), [&](const auto& a, const auto& b) { return a.values[head_.x] < b.values[head_.x]; });
      fail(data_.rows.front().line,
           "no word above the numbers says in what unit " + exactNumber(least->values[head_.x]) + " to " + exactNumber(most->values[head_.x]) +
               (head_.wavelengths ? " are wavelengths" : " are wavelengths or wavenumbers"),
           possible.empty() ? "0.1 to 1000 um" : "a unit: it could be " + all, kSayAxis);
    }
    note(std::string("the wavelengths' unit is not written: ") + nameOf(possible[0]) + ", the only one in which they lie within 0.1 to 1000 um");
    return possible[0];
  }

  std::vector<Point> pointsOf(SpectralAxis axis) {
    std::vector<Point> points;
    std::size_t deleted = 0;
    for (const NumberRow& row : data_.rows) {
      const double x = row.values[head_.x], um = onAxis(axis == SpectralAxis::Micrometre ? x : tidy(micrometres(x, axis))), value = row.values[*head_.y];
      if (!onSpectralAxis(um))
        fail(row.line, exactNumber(x) + " " + nameOf(axis) + " is " + (x > 0.0 ? exactNumber(um) + " um" : "no wavelength"),
             "0.1 to 1000 um (10 to 100000 1/cm)", std::string("remove the row; or, if the unit is another, ") + kSayAxis);
      if (value < kDeleted) ++deleted;
      else points.push_back({um, value, row.line});
    }
    if (deleted > 0) note(std::to_string(deleted) + " channels marked as deleted are left out; lines between their neighbours stand for them");
    if (points.size() < 2) fail(data_.rows.front().line, "fewer than two values that are not marked as deleted", "two at least", "take another spectrum");
    return points;
  }

  double scaleOf(const std::vector<Point>& points) {
    const auto most = std::max_element(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.value < b.value; });
    const std::string greatest = exactNumber(most->value);
    if (choices_.scale) return *choices_.scale;
    if (head_.scale) {
      if (head_.scale->value < 1.0 && most->value <= kMost)
        note("values up to " + greatest + " are taken as per cent, as line " + std::to_string(head_.scale->line) + " says");
      return head_.scale->value;
    }
    if (most->value <= 1.0 || (head_.sharesByCustom && most->value <= kMost)) {
      note("the values' unit is not written: shares of 1, as they are at most " + greatest + "; '--unit %' if they are per cent");
      return 1.0;
    }
    constexpr double kNoShare = 2.0, kMostPercent = 100.0 * kMost;
    if (most->value > kNoShare && most->value <= kMostPercent) {
      note("the values' unit is not written: per cent, as they go up to " + greatest);
      return 0.01;
    }
    fail(most->line, "no word above the numbers says in what unit the values are, which go up to " + greatest,
         most->value > kMostPercent ? "per cent or shares of 1" : "per cent or shares of 1: it could be both", kSayUnit);
  }

  /// Rising, each wavelength once.
  std::vector<Point> ordered(std::vector<Point> points) {
    const bool falls = points.back().um < points.front().um;
    std::vector<Point> kept;
    std::size_t twice = 0;
    for (const Point& p : points) {
      if (!kept.empty() && p.um == kept.back().um) {
        if (std::abs(p.value - kept.back().value) > kSamePlace)
          fail(p.line, "a second value at " + exactNumber(p.um) + " um: " + exactNumber(p.value) + " after " + exactNumber(kept.back().value),
               "one, or two within 0.02", "remove one of the two rows");
        kept.back().value = 0.5 * (kept.back().value + p.value);
        ++twice;
        continue;
      }
      if (!kept.empty() && (p.um < kept.back().um) != falls)
        fail(p.line,
             "the wavelength goes from " + exactNumber(kept.back().um) + (p.um < kept.back().um ? " back to " : " up to ") + exactNumber(p.um) +
                 " um in a spectrum that " + (falls ? "falls" : "rises"),
             "rising or falling all through", "put the rows in order, or correct the wavelength");
      kept.push_back(p);
    }
    if (twice > 0)
      note(std::to_string(twice) + (twice == 1 ? " wavelength that stands twice has" : " wavelengths that stand twice have") + " the mean of both values");
    if (falls) std::reverse(kept.begin(), kept.end());
    return kept;
  }

  /// Into 0 to 1, and tells.
  void bring(std::vector<Point>& points, double scale) {
    std::size_t over = 0, under = 0;
    const Point *most = &points.front(), *least = &points.front();
    for (const Point& p : points) {
      over += p.value > 1.0, under += p.value < 0.0;
      if (p.value > most->value) most = &p;
      if (p.value < least->value) least = &p;
    }
    for (const Point* p : {most, least})
      if (!(p->value <= kMost && p->value >= kLeast))
        fail(p->line, "the value at " + exactNumber(p->um) + " um is " + exactNumber(p->value) + " as a share of 1", "0 to 1, but for what calibration leaves",
             scale == 1.0 ? std::string("correct the row; or, if the values are per cent, say so by '--unit %'") : std::string("correct the row, or its unit"));
    const auto told = [&](std::size_t count, const Point& p, const char* side, const char* extreme, const char* end) {
      if (count > 0)
        note(std::to_string(count) + " of " + std::to_string(points.size()) + (count == 1 ? " values lies " : " values lie ") + side + " (" + extreme + " " +
             exactNumber(p.value) + " at " + exactNumber(p.um) + " um) and " + (count == 1 ? "is" : "are") + " taken as " + end);
    };
    told(over, *most, "over 1", "greatest", "1");
    told(under, *least, "under 0", "least", "0");
    for (Point& p : points) p.value = std::clamp(p.value, 0.0, 1.0);
  }

  std::string yaml(const std::vector<Point>& points, SpectrumQuantity quantity) {
    std::vector<std::vector<double>> rows;
    for (const Point& p : points) rows.push_back({p.um, quantity == SpectrumQuantity::Emissivity ? tidy(1.0 - p.value) : p.value});
    if (quantity == SpectrumQuantity::Emissivity) note("an emissivity: the reflectance is 1 less it, as of an opaque surface");
    if (quantity == SpectrumQuantity::Transmittance)
      note(
          "a transmittance: the spectrum does not say what of the rest is reflected; all of it counts as absorbed, and is emitted, until 'components' are "
          "added");
    std::string out;
    for (const std::string& n : notes_) out += "# note: " + n + "\n";
    const std::size_t first = head_.title.find_first_not_of(" \t");
    out += "description: " + quotedText(first == std::string::npos ? stem_ : head_.title.substr(first)) + "\nsource: " + quotedText(shown_) + "\n";
    const std::string what = nameOf(quantity == SpectrumQuantity::Emissivity ? SpectrumQuantity::Reflectance : quantity);
    const bool through = quantity == SpectrumQuantity::Transmittance;
    out += through ? "transmission:\n  " : "components:\n  - reflection: lambertian\n    ";
    const std::string in = through ? "    " : "      ";
    out += what + ":\n" + in + "wavelength: um\n" + in + "unit: \"1\"\n" + in + "outside: error\n" + in + "values:\n" + in + "  " + rowsOfNumbers(rows) + "\n";
    return out;
  }

  std::string file_, stem_, shown_;
  const ImportChoices& choices_;
  NumberLines data_;
  SpectrumHeader head_;
  std::vector<std::string> notes_;
};

}  // namespace

ImportedMaterial importSpectrum(const std::string& text, const std::filesystem::path& file, const ImportChoices& choices) {
  return Importer(text, file, choices).run();
}

}  // namespace pitviper
