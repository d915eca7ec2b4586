// pitviper atmosphere: what a MODTRAN tape7 or an air table of the library holds, in words, tables and charts.
#include <cmath>
#include <cstdio>

#include "atmosphere/tape7.hpp"
#include "atmosphere/tape7_summary.hpp"
#include "scenarios/commands/air_report.hpp"
#include "scenarios/commands/charts.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", v);
  return std::isnan(v) ? std::string() : text;
}

std::string csvOf(const Tape7Run& run) {
  std::string out = "wavelength [um],wavenumber [1/cm]";
  for (const auto& c : run.columns) {
    const std::string unit = unitOf(c.quantity);
    out += "," + c.name + (unit.empty() || c.quantity == Tape7Quantity::Temperature ? "" : " [" + unit + "]");
  }
  out += "\n";
  for (size_t i = 0; i < run.wavelength_um.size(); ++i) {
    out += number(run.wavelength_um[i]) + "," + number(1e4 / run.wavelength_um[i]);
    for (const auto& c : run.columns) out += "," + number(c.value[i]);
    out += "\n";
  }
  return out;
}

/// Those of a run's columns that are present, in one panel; none if they all are absent.
void addChart(std::vector<Chart>& charts, const Tape7Run& run, const std::string& title, const std::string& unit, const std::vector<const char*>& names) {
  Chart c;
  c.title = title;
  c.xLabel = "wavelength [um]";
  c.yLabel = unit;
  c.yFromZero = true;
  for (const char* name : names)
    if (const Tape7Column* column = run.find(name)) c.series.push_back({name, run.wavelength_um, column->value, false, false});
  if (!c.series.empty()) charts.push_back(c);
}

std::vector<Chart> chartsOf(const Tape7Run& run) {
  std::vector<Chart> charts;
  const std::string which = ", run " + std::to_string(run.number);
  addChart(charts, run, "Transmittance" + which, "transmittance", {"COMBIN_TRANS", "TOT_TRANS", "TRANS"});
  addChart(charts, run, "Its parts" + which, "transmittance", {"H2O_TRANS", "H2O_CONT", "CO2_TRANS", "O3_TRANS", "AER+CLD_TRANS"});
  addChart(charts, run, "Radiance" + which, "W/(m2 sr um)", {"TOTAL_RAD", "PTH_THRML", "SOL_SCAT", "SURF_EMIS", "GRND_RFLT"});
  addChart(charts, run, "Sunlight" + which, "W/(m2 um)", {"SOLAR", "SOL_TR", "TOA_SUN", "SOL@OBS", "REF_SOL"});
  return charts;
}

void showAir(const std::filesystem::path& file, bool write, const std::filesystem::path& out) {
  const AbsorberTable air = AbsorberTable::read(file);
  std::printf("%s", describeAir(air).c_str());
  if (!write) return;
  ensureWritableFolder(out);
  const std::string name = file.stem().string();
  writeFileAtomically(out / (name + ".csv"), airCsv(air));
  std::printf("\n%s written\n", (out / (name + ".csv")).string().c_str());
  drawCharts(airCharts(air), 1, out / (name + ".png"));
  std::printf("%s written\n", (out / (name + ".png")).string().c_str());
}

}  // namespace

int atmosphereCommand(const Arguments& arguments) {
  const Options o("atmosphere", arguments, {{"--out"}}, 1, 1);
  const std::filesystem::path file = o.words()[0], out = o.value("--out");
  const auto named = findLibraries().atmosphere / (o.words()[0] + ".air");
  std::error_code ignored;
  if (file.extension() == ".air" || (!std::filesystem::exists(file, ignored) && std::filesystem::is_regular_file(named, ignored))) {
    showAir(file.extension() == ".air" ? file : named, o.has("--out"), out);
    return 0;
  }
  const auto runs = readTape7(file);
  std::printf("%s: %zu run%s of MODTRAN\n", file.string().c_str(), runs.size(), runs.size() == 1 ? "" : "s");
  for (const auto& run : runs) std::printf("%s", describe(run).c_str());
  if (!o.has("--out")) return 0;
  ensureWritableFolder(out);
  for (const auto& run : runs) {
    const std::string name = file.filename().string() + "_run" + std::to_string(run.number);
    writeFileAtomically(out / (name + ".csv"), csvOf(run));
    std::printf("%s written\n", (out / (name + ".csv")).string().c_str());
    const auto charts = chartsOf(run);
    drawCharts(charts, static_cast<int>(charts.size()), out / (name + ".png"));
    std::printf("%s written\n", (out / (name + ".png")).string().c_str());
  }
  return 0;
}

}  // namespace pitviper
