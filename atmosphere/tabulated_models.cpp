// Air that the user brings as a table: runs of MODTRAN, comma-separated values, or columns of other programs.
#include "atmosphere/models.hpp"
#include "atmosphere/modtran_files.hpp"
#include "atmosphere/tabulated_columns.hpp"
#include "atmosphere/tabulated_csv.hpp"
#include "atmosphere/tabulated_path.hpp"
#include "atmosphere/tabulated_tape7.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/placement.hpp"

namespace pitviper {
namespace {

/// A band of 5000 1/cm by 1 1/cm at seven ranges has 10 MB.
constexpr std::uintmax_t kLargestTableBytes = 64u << 20;

std::filesystem::path tableFile(const AirRecord& air, const char* key, const char* what) {
  const std::filesystem::path file = air.folder / air.record.text(key);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw UserError(air.record.where(key), "there is no file '" + file.string() + "'", std::string(what) + ", its path relative to this file",
                    "check the path");
  if (std::filesystem::file_size(file, ignored) > kLargestTableBytes)
    throw UserError(Location{file.string(), 1, 1, -1}, "the file is larger than 64 MB", std::string(what) + " of the bands that the sensors need",
                    "make it over fewer wavenumbers, or with larger steps");
  return file;
}

/// MODTRAN's air ends at 100 km.
constexpr double kHighest_m = 1e5;

Parameter rangeKey() { return above(within(number("range", "m", "of the only path of a file that does not say it"), 0, kFarthest_m), 0); }

std::optional<double> given(const AirRecord& air, const char* key) { return air.record.given(key) ? std::optional(air.record.number(key)) : std::nullopt; }

/// Far below the end of a float, 3.4e38.
constexpr double kLargestRadiance = 1e30;

std::shared_ptr<const Atmosphere> airOf(TabulatedAir air) {
  for (double w : air.knots_um())
    if (const double source = air.sourceRadiance(w); !(source <= kLargestRadiance)) {
      throw UserError({air.file(), air.line(), 1, -1},
                      print("the air's source radiance, path radiance / (1 - transmittance), is %.6g W/(m2 sr um) at %.6g um", source, w), "at most 1e30",
                      "correct the radiances or their unit");
    }
  return makeTabulatedPath(std::move(air));
}

}  // namespace

AirModel tape7Model() {
  return {"tape7",
          "Air along level paths from MODTRAN runs: the same everywhere and without an end.",
          {"tape7"},
          {required(text("tape7",
                         "file of MODTRAN runs along a horizontal or slant path, relative to the scenario: a tape7, or MODTRAN 6's JSON or CSV; several ranges "
                         "in one file are best")),
           rangeKey(), within(number("height", "m", "of the observer, where the file has runs at several"), -kHighest_m, kHighest_m),
           within(number("elevation", "rad", "of the path, where the file has runs in several directions; 0 is level, which is taken where it is there"),
                  -0.5 * kPi, 0.5 * kPi)},
          [](const AirRecord& air) {
            const auto runs = readModtran(tableFile(air, "tape7", "a tape7 of MODTRAN, or its JSON or CSV"));
            return airOf(tabulatedAir(runs, {given(air, "range"), given(air, "height"), given(air, "elevation")}));
          }};
}

AirModel csvModel() {
  return {"csv",
          "Air along level paths from a table of your own: the same everywhere and without an end.",
          {"csv"},
          {required(
              text("csv", "file of transmittance or extinction by wavelength and range, relative to the scenario; its columns: atmosphere/tabulated_csv.hpp"))},
          [](const AirRecord& air) { return airOf(readAirCsv(tableFile(air, "csv", "a CSV table of air"))); }};
}

AirModel columnsModel() {
  return {"columns",
          "Air along level paths from columns of numbers between blanks, as LBLRTM and libRadtran write them: the same everywhere and without an end.",
          {"columns_file"},
          {required(text("columns_file", "file of transmittance over one path, relative to the scenario; what it may hold: atmosphere/tabulated_columns.hpp")),
           text("radiance_file", "file of path radiance over the same path and wavelengths, where it is apart"),
           text("columns",
                "what the columns hold, where LBLRTM's header or uvspec's input at the head of the file does not say it: as the header of a CSV file, "
                "'wavenumber_1/cm, transmittance, -'"),
           rangeKey()},
          [](const AirRecord& air) {
            const char* const what = "a file of columns";
            ColumnsWanted wanted;
            wanted.range_m = given(air, "range");
            if (air.record.given("columns")) {
              const Value& columns = air.record.value("columns");
              wanted.names = columns.text;
              wanted.namesAt = columns.where;
              wanted.namesAt.column += columns.quoted ? 1 : 0;
            }
            const auto file = tableFile(air, "columns_file", what);
            const auto radiance = air.record.given("radiance_file") ? std::optional(tableFile(air, "radiance_file", what)) : std::nullopt;
            return airOf(readAirColumns(file, wanted, radiance));
          }};
}

}  // namespace pitviper
