#include "scenarios/commands/tabulated_report.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kReportedRanges_m[] = {500.0, 1000.0, 2000.0, 5000.0, 10000.0};

/// Those above and the table's own ends, rising.
std::vector<double> ranges(const TabulatedAir& air) {
  std::vector<double> all(std::begin(kReportedRanges_m), std::end(kReportedRanges_m));
  for (double end : {air.shortestRange_m(), air.longestRange_m()})
    if (end > 0.0 && std::isfinite(end)) all.push_back(end);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return std::abs(a - b) < 1e-6 * b; }), all.end());
  return all;
}

std::string sayRange(double range_m) { return briefNumber(1e-3 * range_m) + " km"; }
std::string sayElevation(double elevation_rad) { return briefNumber(std::round(elevation_rad * 180.0 / kPi * 1e4) / 1e4) + " deg up"; }

/// Over wavelength, trapezoids between the table's own.
double meanTransmittance(const TabulatedAir& air, double range_m, double low_um, double high_um) {
  std::vector<double> at = {low_um};
  for (double w : air.knots_um())
    if (w > low_um && w < high_um) at.push_back(w);
  at.push_back(high_um);
  double sum = 0.0;
  for (size_t i = 1; i < at.size(); ++i) sum += 0.5 * (at[i] - at[i - 1]) * (air.transmittance(at[i], range_m) + air.transmittance(at[i - 1], range_m));
  return sum / (high_um - low_um);
}

}  // namespace

std::string describeTable(const TabulatedAir& air) {
  std::string out = air.description() + "\n" + briefNumber(air.validLow_um()) + " to " + briefNumber(air.validHigh_um()) + " um, " +
                    std::to_string(air.knots_um().size()) + " wavelengths; powers of range:";
  for (double a : air.exponents()) out += " " + briefNumber(a);
  out += "\nlargest difference from the table: transmittance " + briefNumber(air.fit().largest) + " (rms " + briefNumber(air.fit().rms) + ")";
  out += air.emits() ? ", path radiance " + briefNumber(100.0 * air.fit().radiance) + " % of its largest\n" : "; no path radiance in it\n";
  if (const auto& sky = air.sky()) {
    out += "sky known at";
    for (const auto& view : sky->views()) out += (&view == sky->views().data() ? " " : ", ") + sayElevation(view.elevation_rad);
    out += "\n";
  }
  std::vector<std::pair<double, double>> bands;
  for (const auto& [low, high] : {std::pair{0.45, 0.75}, {3.0, 5.0}, {8.0, 12.0}}) {
    const double from = std::max(low, air.validLow_um()), to = std::min(high, air.validHigh_um());
    if (from < to) bands.push_back({from, to});
  }
  if (bands.empty()) bands.push_back({air.validLow_um(), air.validHigh_um()});
  out += "\n| mean transmittance |";
  for (const auto& [low, high] : bands) out += " " + briefNumber(low) + "-" + briefNumber(high) + " um |";
  out += "\n|---|";
  for (size_t i = 0; i < bands.size(); ++i) out += "---|";
  out += "\n";
  for (double range : ranges(air)) {
    out += "| " + sayRange(range) +
           (range < air.shortestRange_m() * (1 - 1e-9) || range > air.longestRange_m() * (1 + 1e-9) ? " (outside the table's ranges) |" : " |");
    for (const auto& [low, high] : bands) {
      out += print(" %.4f |", meanTransmittance(air, range, low, high));
    }
    out += "\n";
  }
  return out;
}

std::string tableCsv(const TabulatedAir& air) {
  std::string out = "wavelength [um],wavenumber [1/cm]";
  const auto at = ranges(air);
  for (double a : air.exponents()) out += ",depth of the first km of power " + briefNumber(a);
  out += ",source radiance [W/(m2 sr um)]";
  for (double r : at) out += ",transmittance " + sayRange(r);
  for (double r : at) out += ",path radiance " + sayRange(r) + " [W/(m2 sr um)]";
  const auto& sky = air.sky();
  if (sky)
    for (const auto& view : sky->views()) out += ",sky radiance " + sayElevation(view.elevation_rad) + " [W/(m2 sr um)]";
  out += "\n";
  for (double w : air.knots_um()) {
    out += briefNumber(w) + "," + briefNumber(1e4 / w);
    for (double c : air.coefficients(w)) out += "," + briefNumber(c);
    out += "," + briefNumber(air.sourceRadiance(w));
    for (double r : at) out += "," + briefNumber(air.transmittance(w, r));
    for (double r : at) out += "," + briefNumber(air.pathRadiance(w, r));
    if (sky)
      for (const auto& view : sky->views())
        out += "," + (w >= sky->knots_um().front() && w <= sky->knots_um().back() ? briefNumber(sky->radiance(w, view.elevation_rad)) : std::string());
    out += "\n";
  }
  return out;
}

std::vector<Chart> tableCharts(const TabulatedAir& air) {
  const std::vector<double> knots(air.knots_um().begin(), air.knots_um().end());
  Chart tau, radiance;
  tau.title = "Transmittance";
  tau.yLabel = "transmittance";
  radiance.title = "Path radiance";
  radiance.yLabel = "W/(m2 sr um)";
  for (double r : ranges(air)) {
    Series t{sayRange(r), knots, {}, false, false}, l{sayRange(r), knots, {}, false, false};
    for (double w : knots) {
      t.y.push_back(air.transmittance(w, r));
      l.y.push_back(air.pathRadiance(w, r));
    }
    tau.series.push_back(std::move(t));
    radiance.series.push_back(std::move(l));
  }
  std::vector<Chart> charts = {tau};
  if (air.emits()) charts.push_back(radiance);
  if (const auto& sky = air.sky()) {
    Chart c;
    c.title = "Sky radiance";
    c.yLabel = "W/(m2 sr um)";
    const std::vector<double> at(sky->knots_um().begin(), sky->knots_um().end());
    for (const auto& view : sky->views()) c.series.push_back({sayElevation(view.elevation_rad), at, view.radiance, false, false});
    charts.push_back(c);
  }
  for (Chart& c : charts) {
    c.xLabel = "wavelength [um]";
    c.yFromZero = true;
  }
  return charts;
}

}  // namespace pitviper
