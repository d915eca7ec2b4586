#include "scenarios/commands/air_report.hpp"

#include <cmath>

#include "atmosphere/scattered_sun.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// As scenarios' local frame has it, to a third of a per cent anywhere on the earth.
constexpr double kEarthRadius_m = 6371e3;
constexpr double kStep_per_cm = 20.0;

struct ReportedPath {
  const char* name;
  double height_m, elevation_deg, range_m;
};
/// From the ground; the last one leaves the air.
constexpr ReportedPath kPaths[] = {
    {"level 1 km", 0, 0, 1e3}, {"level 5 km", 0, 0, 5e3}, {"level 10 km", 0, 0, 1e4}, {"30 deg up, 10 km", 0, 30, 1e4}, {"up to space", 0, 90, 1e7}};

/// Where the sun stands, a black body; what is looked at lies at a right angle to it in azimuth.
constexpr double kSunElevation_deg = 45.0, kSunTemperature_K = 5772.0, kSunSolidAngle_sr = 6.7943e-5;
constexpr const char* kSun = "sun 45 deg up, 90 deg to the side";
constexpr double kSkyElevations_deg[] = {5.0, 20.0, 45.0, 90.0};
constexpr double kSunElevations_deg[] = {5.0, 20.0, 45.0, 90.0};

double sineOf(double degrees) { return std::sin(degrees * 3.14159265358979324 / 180.0); }
double sunAbove(double wavelength_um) { return kSunSolidAngle_sr * physics::planckRadiance(wavelength_um, kSunTemperature_K); }

double sine(const ReportedPath& p) { return sineOf(p.elevation_deg); }

AbsorberAmounts amountsOf(const AbsorberTable& air, const ReportedPath& p) { return air.amounts(p.height_m, sine(p), p.range_m, kEarthRadius_m); }

std::vector<double> wavelengths(const AbsorberTable& air) {
  std::vector<double> all;
  for (double nu = 1e4 / air.validLow_um(); nu >= 1e4 / air.validHigh_um() - 1e-9; nu -= kStep_per_cm) all.push_back(std::min(1e4 / nu, air.validHigh_um()));
  return all;
}

/// Mean over wavelength of a value at a wavelength; nothing where the table does not cover the band.
template <typename F>
std::string bandMean(const AbsorberTable& air, double low_um, double high_um, F&& value) {
  if (low_um < air.validLow_um() || high_um > air.validHigh_um()) return "-";
  constexpr int kPoints = 800;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) sum += value(low_um + (high_um - low_um) * (i + 0.5) / kPoints) / kPoints;
  return print("%.4g", sum);
}

constexpr std::pair<double, double> kBands_um[] = {{0.45, 0.75}, {3.0, 5.0}, {3.5, 4.1}, {8.0, 12.0}};
constexpr const char* kBandNames = " | 0.45-0.75 um | 3-5 um | 3.5-4.1 um | 8-12 um |\n|---|---|---|---|---|\n";

/// Geometry common to all wavelengths.
struct Views {
  ScatteredSun sun;
  std::vector<SunlitPath> paths, sky;
  std::vector<AbsorberAmounts> sunPaths;

  explicit Views(const AbsorberTable& air) : sun(std::make_shared<const AbsorberTable>(air), kEarthRadius_m) {
    const double aside = 0.5 * 3.14159265358979324;
    for (const ReportedPath& p : kPaths) paths.push_back(sun.path({p.height_m, sine(p), aside, sineOf(kSunElevation_deg)}, p.range_m));
    for (double e : kSkyElevations_deg) sky.push_back(sun.pathToEnd({0.0, sineOf(e), aside, sineOf(kSunElevation_deg)}));
    for (double e : kSunElevations_deg) sunPaths.push_back(air.amounts(0.0, sineOf(e), INFINITY, kEarthRadius_m));
  }
  double path(double w, size_t i) const { return sun.radiance(w, paths[i], sunAbove(w)); }
  double skyAt(double w, size_t i) const { return sun.radiance(w, sky[i], sunAbove(w)); }
  double sunAtGround(double w, size_t i) const { return sunAbove(w) * sun.air().transmittance(w, sunPaths[i]); }
};

std::string degreesUp(double degrees) { return briefNumber(degrees) + " deg up"; }

}  // namespace

std::string describeAir(const AbsorberTable& air) {
  std::string out = air.title() + "\n" + air.source() + "\n" + briefNumber(air.validLow_um()) + " to " + briefNumber(air.validHigh_um()) + " um, " +
                    std::to_string(air.absorbers().size()) + " absorbers:";
  for (const Absorber& a : air.absorbers()) out += " " + a.name + (a.exponent == 1.0 ? "" : "^" + briefNumber(a.exponent));
  const auto row = [&](const std::string& name, auto&& value) {
    out += "| " + name;
    for (const auto& [low, high] : kBands_um) out += " | " + bandMean(air, low, high, value);
    out += " |\n";
  };
  const Views views(air);
  out += std::string("\n\n| mean transmittance") + kBandNames;
  for (const ReportedPath& p : kPaths) {
    const AbsorberAmounts amounts = amountsOf(air, p);
    row(p.name, [&](double w) { return air.transmittance(w, amounts); });
  }
  out += std::string("\nThermal radiance of what absorbs and sunlight scattered once (in the visible less than the whole); ") + kSun + ".\n\n";
  out += std::string("| mean radiance [W/(m2 sr um)]") + kBandNames;
  for (size_t i = 0; i < std::size(kPaths); ++i) row(std::string("path, ") + kPaths[i].name, [&](double w) { return views.path(w, i); });
  for (size_t i = 0; i < std::size(kSkyElevations_deg); ++i) row("sky, " + degreesUp(kSkyElevations_deg[i]), [&](double w) { return views.skyAt(w, i); });
  out += std::string("\n| sun, 5772 K [W/(m2 um)]") + kBandNames;
  row("above the air", sunAbove);
  for (size_t i = 0; i < std::size(kSunElevations_deg); ++i)
    row("at the ground, " + degreesUp(kSunElevations_deg[i]), [&](double w) { return views.sunAtGround(w, i); });
  return out;
}

std::string airCsv(const AbsorberTable& air) {
  std::string out = "wavelength [um],wavenumber [1/cm]";
  std::vector<AbsorberAmounts> amounts;
  for (const ReportedPath& p : kPaths) {
    out += std::string(",transmittance ") + p.name;
    amounts.push_back(amountsOf(air, p));
  }
  for (const ReportedPath& p : kPaths) out += std::string(",thermal path radiance ") + p.name + " [W/(m2 sr um)]";
  for (const ReportedPath& p : kPaths) out += std::string(",path radiance with the sun ") + p.name + " [W/(m2 sr um)]";
  for (double e : kSkyElevations_deg) out += ",sky radiance " + degreesUp(e) + " [W/(m2 sr um)]";
  out += ",sun above the air [W/(m2 um)]";
  for (double e : kSunElevations_deg) out += ",sun at the ground " + degreesUp(e) + " [W/(m2 um)]";
  out += "\n";
  const Views views(air);
  for (double w : wavelengths(air)) {
    out += briefNumber(w) + "," + briefNumber(1e4 / w);
    for (const auto& a : amounts) out += "," + briefNumber(air.transmittance(w, a));
    for (const auto& p : views.paths) out += "," + briefNumber(views.sun.thermalRadiance(w, p));
    for (size_t i = 0; i < views.paths.size(); ++i) out += "," + briefNumber(views.path(w, i));
    for (size_t i = 0; i < views.sky.size(); ++i) out += "," + briefNumber(views.skyAt(w, i));
    out += "," + briefNumber(sunAbove(w));
    for (size_t i = 0; i < views.sunPaths.size(); ++i) out += "," + briefNumber(views.sunAtGround(w, i));
    out += "\n";
  }
  return out;
}

std::vector<Chart> airCharts(const AbsorberTable& air) {
  const auto at = wavelengths(air);
  const Views views(air);
  const auto chart = [&](const char* title, const char* unit, bool logarithmic) {
    Chart c;
    c.title = title;
    c.xLabel = "wavelength [um]";
    c.yLabel = unit;
    c.logX = true;
    c.xTicks = {0.4, 0.7, 1, 2, 3, 5, 8, 12};
    c.logY = logarithmic;
    c.yFromZero = !logarithmic;
    return c;
  };
  std::vector<Chart> charts = {chart("Transmittance", "transmittance", false), chart("Path radiance, sun 45 deg up and to the side", "W/(m2 sr um)", true),
                               chart("Sky radiance, sun 45 deg up and to the side", "W/(m2 sr um)", true), chart("Sun at the ground", "W/(m2 um)", true)};
  const auto add = [&](size_t panel, const std::string& name, auto&& value, bool dashed = false) {
    Series s{name, at, {}, dashed, false};
    for (double w : at) s.y.push_back(value(w));
    charts[panel].series.push_back(std::move(s));
  };
  for (size_t i = 0; i < std::size(kPaths); ++i) {
    const AbsorberAmounts amounts = amountsOf(air, kPaths[i]);
    add(0, kPaths[i].name, [&](double w) { return air.transmittance(w, amounts); });
    add(1, kPaths[i].name, [&](double w) { return views.path(w, i); });
  }
  for (size_t i = 0; i < std::size(kSkyElevations_deg); ++i) add(2, degreesUp(kSkyElevations_deg[i]), [&](double w) { return views.skyAt(w, i); });
  add(3, "above the air", sunAbove, true);
  for (size_t i = 0; i < std::size(kSunElevations_deg); ++i) {
    // What is left of opaque bands lies hundreds of decades below: it is drawn on the floor.
    add(3, degreesUp(kSunElevations_deg[i]), [&](double w) { return std::max(views.sunAtGround(w, i), 1e-4); });
  }
  return charts;
}

}  // namespace pitviper
