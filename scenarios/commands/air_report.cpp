#include "scenarios/commands/air_report.hpp"

#include <cmath>
#include <cstdio>

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

double sine(const ReportedPath& p) { return std::sin(p.elevation_deg * 3.14159265358979324 / 180.0); }

AbsorberAmounts amountsOf(const AbsorberTable& air, const ReportedPath& p) { return air.amounts(p.height_m, sine(p), p.range_m, kEarthRadius_m); }

std::vector<double> wavelengths(const AbsorberTable& air) {
  std::vector<double> all;
  for (double nu = 1e4 / air.validLow_um(); nu >= 1e4 / air.validHigh_um() - 1e-9; nu -= kStep_per_cm) all.push_back(std::min(1e4 / nu, air.validHigh_um()));
  return all;
}

/// Mean over wavelength; nothing where the table does not cover the band.
std::string bandMean(const AbsorberTable& air, const AbsorberAmounts& amounts, double low_um, double high_um) {
  if (low_um < air.validLow_um() || high_um > air.validHigh_um()) return "-";
  constexpr int kPoints = 800;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) sum += air.transmittance(low_um + (high_um - low_um) * (i + 0.5) / kPoints, amounts) / kPoints;
  char text[16];
  std::snprintf(text, sizeof text, "%.4f", sum);
  return text;
}

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

}  // namespace

std::string describeAir(const AbsorberTable& air) {
  std::string out = air.title() + "\n" + air.source() + "\n" + number(air.validLow_um()) + " to " + number(air.validHigh_um()) + " um, " +
                    std::to_string(air.absorbers().size()) + " absorbers:";
  for (const Absorber& a : air.absorbers()) out += " " + a.name + (a.exponent == 1.0 ? "" : "^" + number(a.exponent));
  out += "\n\n| mean transmittance | 0.45-0.75 um | 3-5 um | 3.5-4.1 um | 8-12 um |\n|---|---|---|---|---|\n";
  for (const ReportedPath& p : kPaths) {
    const AbsorberAmounts amounts = amountsOf(air, p);
    out += std::string("| ") + p.name;
    for (const auto& [low, high] : {std::pair{0.45, 0.75}, {3.0, 5.0}, {3.5, 4.1}, {8.0, 12.0}}) out += " | " + bandMean(air, amounts, low, high);
    out += " |\n";
  }
  return out;
}

std::string airCsv(const AbsorberTable& air) {
  std::string out = "wavelength [um],wavenumber [1/cm]";
  std::vector<AbsorberAmounts> amounts;
  std::vector<std::vector<PathStation>> stations;
  for (const ReportedPath& p : kPaths) {
    out += std::string(",transmittance ") + p.name;
    amounts.push_back(amountsOf(air, p));
    stations.push_back(air.stations(p.height_m, sine(p), p.range_m, kEarthRadius_m));
  }
  for (const ReportedPath& p : kPaths) out += std::string(",path radiance ") + p.name + " [W/(m2 sr um)]";
  out += "\n";
  for (double w : wavelengths(air)) {
    out += number(w) + "," + number(1e4 / w);
    for (const auto& a : amounts) out += "," + number(air.transmittance(w, a));
    for (const auto& s : stations) out += "," + number(air.pathRadiance(w, s));
    out += "\n";
  }
  return out;
}

std::vector<Chart> airCharts(const AbsorberTable& air) {
  std::vector<Chart> charts(2);
  charts[0].title = "Transmittance";
  charts[0].yLabel = "transmittance";
  charts[1].title = "Thermal path radiance";
  charts[1].yLabel = "W/(m2 sr um)";
  for (Chart& c : charts) {
    c.xLabel = "wavelength [um]";
    c.yFromZero = true;
  }
  const auto at = wavelengths(air);
  for (const ReportedPath& p : kPaths) {
    const AbsorberAmounts amounts = amountsOf(air, p);
    const auto stations = air.stations(p.height_m, sine(p), p.range_m, kEarthRadius_m);
    Series tau{p.name, at, {}, false, false}, radiance{p.name, at, {}, false, false};
    for (double w : at) {
      tau.y.push_back(air.transmittance(w, amounts));
      radiance.y.push_back(air.pathRadiance(w, stations));
    }
    charts[0].series.push_back(std::move(tau));
    charts[1].series.push_back(std::move(radiance));
  }
  return charts;
}

}  // namespace pitviper
