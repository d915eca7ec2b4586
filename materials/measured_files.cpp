#include "materials/measured_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "sim/parameters/csv_table.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "sim/parameters/table.hpp"
#include "sim/parameters/units.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Of MERL: half angles, difference angles, azimuths. Each value is of the middle of its cell.
constexpr std::size_t kHalves = 90, kDifferences = 90, kAzimuths = 180, kEach = kHalves * kDifferences * kAzimuths;
constexpr std::array<double, 3> kScale{1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
/// What red, green and blue cover together.
constexpr double kFirst_um = 0.4, kLast_um = 0.7;

constexpr std::size_t kMostRows = 4000000;

/// Rising, each once; angles within a millionth of a radian are the same.
std::vector<double> valuesOf(const CsvTable& t, std::size_t column, double scale, double apart) {
  std::vector<double> all;
  for (std::size_t row = 0; row < t.rows(); ++row) all.push_back(t.at(row, column) * scale);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [apart](double a, double b) { return b - a < apart; }), all.end());
  return all;
}

std::size_t placeIn(const std::vector<double>& all, double value) {
  const auto above = static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), value) - all.begin());
  if (above == 0) return 0;
  return above == all.size() || value - all[above - 1] < all[above] - value ? above - 1 : above;
}

/// A column by its name, and what its numbers are to be multiplied by; none where there is no such column.
struct Found {
  std::size_t column;
  double scale;
};

std::optional<Found> find(const CsvTable& t, const std::string& name, const std::string& unit) {
  for (std::size_t k = 0; k < t.columns.size(); ++k) {
    if (t.columns[k].name != name) continue;
    const auto scale = convert({1.0, t.columns[k].unit}, unit);
    if (!scale) throw UserError(t.columns[k].where, "the column '" + name + "' is in '" + t.columns[k].unit + "'", unitExample(unit), "change its unit");
    return Found{k, *scale};
  }
  return {};
}

Found need(const CsvTable& t, const std::string& name, const std::string& unit) {
  if (const auto found = find(t, name, unit)) return *found;
  throw UserError(t.columns.front().where, "a BRDF without the column '" + name + "'",
                  "a header such as 'wavelength [um], incidence [deg], view [deg], azimuth [deg], brdf [1/sr]'", "add it");
}

}  // namespace

MeasuredGrid readMerl(const std::filesystem::path& file, const std::array<double, 3>& bands_um, const Location& askedAt) {
  constexpr std::size_t kBytes = 12 + 3 * kEach * sizeof(double);
  const std::string bytes = readWholeFile(file,
                                          {.what = "a BRDF in MERL's layout (" + std::to_string(kBytes) + " bytes)",
                                           .mostBytes = kBytes,
                                           .fix = "check the name; it is relative to the file that names it",
                                           .fixLarge = "give a file of 90 x 90 x 180 angles and three colours"},
                                          askedAt);
  const auto integer = [&](std::size_t at) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 4; ++k) v |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
    return v;
  };
  const Location start{file.string(), 0, 0, 0};
  if (bytes.size() < 12 || integer(0) != kHalves || integer(4) != kDifferences || integer(8) != kAzimuths)
    throw UserError(start, "not a BRDF in MERL's layout", "three integers 90, 90, 180 at its beginning", "check that this is the file you mean");
  if (bytes.size() != kBytes)
    throw UserError({file.string(), 0, 0, static_cast<long long>(bytes.size())}, "the BRDF ends after " + std::to_string(bytes.size()) + " bytes",
                    std::to_string(kBytes), "fetch it once more");
  MeasuredGrid grid;
  grid.kind = MeasuredAngles::HalfRoot;
  grid.mostHoles = 0.05;
  grid.entries = {static_cast<int>(kHalves) + 1, static_cast<int>(kDifferences) / 2 + 1};
  const auto middles = [](std::size_t count, double last) {
    std::vector<double> all;
    for (std::size_t k = 0; k < count; ++k) all.push_back(last * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
    return all;
  };
  grid.angle1_rad = middles(kHalves, 0.5 * kPi);
  grid.angle2_rad = middles(kDifferences, 0.5 * kPi);
  grid.azimuth_rad = middles(kAzimuths, kPi);
  std::vector<std::size_t> colour;  // by wavelength, from blue to red; held to the ends of what is seen
  const auto add = [&](double wavelength_um, std::size_t own) {
    grid.wavelength_um.push_back(wavelength_um);
    colour.push_back(own);
  };
  if (bands_um[2] > kFirst_um) add(kFirst_um, 2);
  for (std::size_t k = 3; k-- > 0;) add(bands_um[k], k);
  if (bands_um[0] < kLast_um) add(kLast_um, 0);
  grid.values.reserve(kEach * colour.size());
  for (std::size_t p = 0; p < kAzimuths; ++p)
    for (std::size_t d = 0; d < kDifferences; ++d)
      for (std::size_t h = 0; h < kHalves; ++h)
        for (std::size_t c : colour) {
          double value = 0.0;
          std::memcpy(&value, bytes.data() + 12 + sizeof value * (c * kEach + (h * kDifferences + d) * kAzimuths + p), sizeof value);
          value *= kScale[c];
          grid.values.push_back(value >= 0.0 && std::isfinite(value) ? value : kNone);
        }
  return grid;
}

MeasuredGrid readBrdfCsv(const std::filesystem::path& file, const Location& askedAt) {
  const CsvTable t = readCsvTable(file,
                                  {.what = "a CSV file with a BRDF of at most " + std::to_string(kMostRows) + " rows",
                                   .mostBytes = std::uintmax_t{512} << 20,
                                   .fix = "check the name; it is relative to the file that names it",
                                   .fixLarge = "thin the table out"},
                                  kMostRows, askedAt);
  const bool ofHalf = find(t, "half", "rad").has_value();
  const std::array<Found, 5> columns{need(t, "wavelength", "um"), need(t, ofHalf ? "half" : "incidence", "rad"), need(t, ofHalf ? "difference" : "view", "rad"),
                                     need(t, "azimuth", "rad"), need(t, "brdf", "1/sr")};
  if (t.rows() == 0) throw UserError({t.file, 1, 1, -1}, "a BRDF without rows", "a row for each wavelength and angles", "add them");
  constexpr double kSameAngle = 1e-6, kSameWavelength_um = 1e-9;
  MeasuredGrid grid;
  grid.kind = ofHalf ? MeasuredAngles::Half : MeasuredAngles::Directions;
  std::array<std::vector<double>*, 4> axes{&grid.wavelength_um, &grid.angle1_rad, &grid.angle2_rad, &grid.azimuth_rad};
  for (std::size_t k = 0; k < 4; ++k) *axes[k] = valuesOf(t, columns[k].column, columns[k].scale, k == 0 ? kSameWavelength_um : kSameAngle);
  double crossings = 1.0;
  for (const auto* axis : axes) crossings *= static_cast<double>(axis->size());
  if (crossings > 8.0 * static_cast<double>(t.rows()))
    throw UserError({t.file, 1, 1, -1},
                    std::to_string(t.rows()) + " rows for " + std::to_string(grid.wavelength_um.size()) + " wavelengths, " +
                        std::to_string(grid.angle1_rad.size()) + " and " + std::to_string(grid.angle2_rad.size()) + " angles and " +
                        std::to_string(grid.azimuth_rad.size()) + " azimuths",
                    "one for each crossing of them", "round angles that are meant to be the same");
  grid.values.assign(static_cast<std::size_t>(crossings), kNone);
  for (std::size_t row = 0; row < t.rows(); ++row) {
    const auto value = [&](std::size_t k) { return t.at(row, columns[k].column) * columns[k].scale; };
    if (!(value(4) >= 0.0)) throw UserError(t.whereOf(row), "a BRDF below 0", "at least 0 per steradian", "correct the row");
    if (!(value(0) >= kShortestWavelength_um && value(0) <= kLongestWavelength_um))
      throw UserError(t.whereOf(row), "a wavelength off the spectral axis", "0.1 to 1000 um", "correct the row");
    if (!(value(1) >= 0.0 && value(1) <= 0.5 * kPi + kSameAngle && value(2) >= 0.0 && value(2) <= 0.5 * kPi + kSameAngle &&
          std::abs(value(3)) <= 2.0 * kPi + kSameAngle))
      throw UserError(t.whereOf(row), "an angle out of range", "0 to 90 deg, of the azimuth -360 to 360 deg", "correct the row");
    std::size_t at = 0;
    for (std::size_t k : {3, 2, 1, 0}) at = at * axes[k]->size() + placeIn(*axes[k], value(k));
    if (!std::isnan(grid.values[at])) throw UserError(t.whereOf(row), "a second value for the same wavelength and angles", "one row for each", "remove one");
    grid.values[at] = value(4);
  }
  return grid;
}

}  // namespace pitviper
