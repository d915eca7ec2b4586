// pitviper atmosphere: what runs of MODTRAN, a table of air or an air table of the library hold, in words, tables and charts.
#include <cmath>
#include <cstdio>
#include <optional>

#include "atmosphere/modtran_csv.hpp"
#include "atmosphere/modtran_files.hpp"
#include "atmosphere/tabulated_columns.hpp"
#include "atmosphere/tabulated_csv.hpp"
#include "atmosphere/tabulated_tape7.hpp"
#include "atmosphere/tape7.hpp"
#include "atmosphere/tape7_summary.hpp"
#include "scenarios/commands/air_report.hpp"
#include "scenarios/commands/charts.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/tabulated_report.hpp"
#include "scenarios/reader/library_air.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// As large as its readers take.
constexpr std::uintmax_t kLargestFile = 64u << 20;

std::string number(double v) { return std::isnan(v) ? std::string() : print("%.9g", v); }

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

void showAir(const AbsorberTable& air, const std::string& name, const std::optional<std::filesystem::path>& out) {
  std::printf("%s", describeAir(air).c_str());
  if (!out) return;
  std::printf("\n");
  writeWithCharts(*out, name, airCsv(air), airCharts(air), 2);
}

void listLibrary(const Libraries& libraries) {
  std::printf("library airs (pitviper atmosphere NAME shows one; 'atmosphere: NAME' in a scenario takes it):\n");
  for (const LibraryAir& air : libraryAirs(libraries)) std::printf("  %-12s %s\n", air.name.c_str(), air.description.c_str());
}

void showTable(const TabulatedAir& air, const std::string& name, const std::optional<std::filesystem::path>& out) {
  std::printf("%s", describeTable(air).c_str());
  if (!out) return;
  const auto charts = tableCharts(air);
  writeWithCharts(*out, name, tableCsv(air), charts, static_cast<int>(charts.size()));
}

void showModtran(const std::filesystem::path& file, const PathChoice& choice, const std::optional<std::filesystem::path>& out) {
  const auto runs = readModtran(file);
  std::printf("%s: %zu run%s of MODTRAN\n", file.string().c_str(), runs.size(), runs.size() == 1 ? "" : "s");
  for (const auto& run : runs) std::printf("%s", describe(run).c_str());
  const std::string name = file.filename().string();
  if (out)
    for (const auto& run : runs) {
      const auto charts = chartsOf(run);
      writeWithCharts(*out, name + "_run" + std::to_string(run.number), csvOf(run), charts, static_cast<int>(charts.size()));
    }
  // Not every file is air along a path: of one that is not, the reason is part of what there is to know.
  std::optional<TabulatedAir> air;
  try {
    air = tabulatedAir(runs, choice);
  } catch (const UserError& e) {
    if (choice.range_m || choice.height_m || choice.elevation_rad) throw;
    std::printf("as air: no; %s\n", e.what());
    return;
  }
  std::printf("as air: ");
  showTable(*air, name + "_air", out);
}

struct AirWish {
  std::string out, columns, radiance;
  std::optional<double> range_km, height_km, elevation_deg;
};

/// The first of these options that was given, or none.
std::string firstGiven(const std::vector<std::pair<const char*, bool>>& options) {
  for (const auto& [name, isGiven] : options)
    if (isGiven) return name;
  return "";
}

/// Errors: UserError for options that say nothing about this kind of file.
void refuseOptions(const std::string& given, const std::string& word, const char* expected, const char* fix) {
  if (!given.empty()) throw UserError({}, given + " with '" + word + "'", expected, fix);
}

int showAirs(const AirWish& w, const std::string& word) {
  const Libraries libraries = findLibraries();
  const std::filesystem::path file = word;
  const auto out = w.out.empty() ? std::nullopt : std::optional<std::filesystem::path>(w.out);
  if (out) ensureWritableFolder(*out);
  const auto inMetres = [](std::optional<double> km) { return km ? std::optional(1e3 * *km) : std::nullopt; };
  const PathChoice choice{inMetres(w.range_km), inMetres(w.height_km), w.elevation_deg ? std::optional(*w.elevation_deg * kPi / 180.0) : std::nullopt};
  // A word without folder and extension that is no file is a name: of a table of the library, or of a library air.
  std::error_code ignored;
  const bool named = !std::filesystem::exists(file, ignored) && file.extension().empty() && !file.has_parent_path();
  const auto table = libraries.atmosphere / (word + ".air");
  const std::string ofPath = firstGiven({{"--height", w.height_km.has_value()}, {"--elevation", w.elevation_deg.has_value()}}),
                    ofColumns = firstGiven({{"--columns", !w.columns.empty()}, {"--radiance", !w.radiance.empty()}}),
                    ofAny = firstGiven({{"--range", w.range_km.has_value()}, {ofPath.c_str(), !ofPath.empty()}, {ofColumns.c_str(), !ofColumns.empty()}});
  const char* const leaveOut = "leave it out: air tables and CSV files have their ranges";
  if (named || file.extension() == ".air") {
    refuseOptions(ofAny, word, "a file of MODTRAN's or of columns", leaveOut);
    if (named && !std::filesystem::is_regular_file(table, ignored)) {
      const AbsorberTable air = libraryAirTable(word, libraries);
      for (const LibraryAir& a : libraryAirs(libraries))
        if (a.name == word) std::printf("%s: %s; its table:\n", word.c_str(), a.description.c_str());
      showAir(air, word, out);
    } else {
      showAir(AbsorberTable::read(named ? table : file), named ? word : file.stem().string(), out);
    }
    return 0;
  }
  const std::string text = readWholeFile(file, {.what = "a file of air", .mostBytes = kLargestFile, .fix = "check its name"});
  if (!ofColumns.empty() || isAirColumns(text)) {
    refuseOptions(ofPath, word, "a file of MODTRAN's", "leave it out: columns are of one path");
    ColumnsWanted wanted{.namesAt = {"--columns", 1, 1, -1}, .range_m = choice.range_m};
    if (!w.columns.empty()) wanted.names = w.columns;
    showTable(readAirColumns(file, wanted, w.radiance.empty() ? std::nullopt : std::optional<std::filesystem::path>(w.radiance)), file.filename().string(),
              out);
  } else if (file.extension() == ".csv" && !isModtranCsv(text)) {
    refuseOptions(ofAny, word, "a file of MODTRAN's or of columns", leaveOut);
    showTable(readAirCsv(file), file.stem().string(), out);
  } else {
    showModtran(file, choice, out);
  }
  return 0;
}

}  // namespace

CommandLine atmosphereCommand() {
  const auto w = std::make_shared<AirWish>();
  return {
      {"atmosphere", "[NAME|FILE]", "what air there is in the library, in runs of MODTRAN, or in a table of your own, as tables and charts"},
      "Without an argument: the library airs. NAME: one of them (clear_mls), or an air table (us76_rural), as FILE.air: mean transmittance and radiance of "
      "level and slant paths, sky, sun at the ground.\n"
      "FILE.csv: air by tables; the columns it may have are listed at the head of atmosphere/tabulated_csv.hpp, for instance wavelength_um, range_km, "
      "transmittance, path_radiance_W/(m2 sr um).\n"
      "FILE of columns between blanks: LBLRTM's (TAPE28) or uvspec's with its input at the head; or any with --columns.\n"
      "FILE: runs of MODTRAN, its tape7 (.tp7) or MODTRAN 6's JSON or CSV, transmittance, thermal radiance with or without the sun or solar irradiance, any "
      "number of runs; prints for each: kind, model, path, wavelengths and step, mean transmittance in 3-5 and 8-12 um where covered; and how it serves as "
      "air along a path.",
      {{"--range", "KM", "of the only path in a file that does not say it", number(w->range_km, {1e-6, 1e5, "km", true}), "NAME|FILE"},
       {"--height", "KM", "of the observer, where MODTRAN's runs are at several heights", number(w->height_km, {-100.0, 100.0, "km", true}), "NAME|FILE"},
       {"--elevation", "DEG", "of the path, where MODTRAN's runs have several; 0: level", number(w->elevation_deg, {-90.0, 90.0, "deg", true}), "NAME|FILE"},
       {"--columns", "NAMES", "what the columns of a file hold, as the header of a CSV file: 'wavenumber_1/cm, transmittance'", into(w->columns), "NAME|FILE"},
       {"--radiance", "FILE", "of path radiance, where a file of columns has it apart (LBLRTM's TAPE27 beside TAPE28)", into(w->radiance), "NAME|FILE"},
       {"--out", "FOLDER",
        "also NAME.csv, FILE_run<N>.csv or FILE_air.csv, every column over wavelength in W/(m2 sr um) or W/(m2 um), and a chart of the same name (PNG, "
        "needs VTK), in FOLDER; created if missing",
        into(w->out), "NAME|FILE"}},
      [w](const Arguments& words) {
        if (!words.empty()) return showAirs(*w, words[0]);
        listLibrary(findLibraries());
        return 0;
      }};
}

}  // namespace pitviper
