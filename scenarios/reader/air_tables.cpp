// Air that the user brings as a table: a tape7 of MODTRAN or comma-separated values.
#include "atmosphere/tabulated_csv.hpp"
#include "atmosphere/tabulated_path.hpp"
#include "atmosphere/tabulated_tape7.hpp"
#include "scenarios/reader/builder.hpp"

namespace pitviper {
namespace {

/// A band of 5000 1/cm by 1 1/cm at seven ranges has 10 MB.
constexpr std::uintmax_t kLargestTableBytes = 64u << 20;

std::filesystem::path tableFile(const Record& r, const char* key, const std::filesystem::path& folder, const char* what) {
  const std::filesystem::path file = folder / r.text(key);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw UserError(r.where(key), "there is no file '" + file.string() + "'", std::string(what) + ", its path relative to this file", "check the path");
  if (std::filesystem::file_size(file, ignored) > kLargestTableBytes)
    throw UserError(Location{file.string(), 1, 1, -1}, "the file is larger than 64 MB", std::string(what) + " of the bands that the sensors need",
                    "make it over fewer wavenumbers, or with larger steps");
  return file;
}

/// Far below the end of a float, 3.4e38.
constexpr double kLargestRadiance = 1e30;

std::shared_ptr<const Path> pathOf(TabulatedAir air) {
  for (double w : air.knots_um())
    if (!(air.sourceRadiance(w) <= kLargestRadiance))
      throw UserError({air.file(), air.line(), 1, -1},
                      "the air's source radiance, path radiance / (1 - transmittance), is " + briefNumber(air.sourceRadiance(w)) + " W/(m2 sr um) at " +
                          briefNumber(w) + " um",
                      "at most 1e30", "correct the radiances or their unit");
  return makeTabulatedPath(std::move(air));
}

}  // namespace

bool Builder::readTabulatedAir(const Record& r) {
  const bool tape7 = r.given("tape7"), csv = r.given("csv");
  if (!tape7 && !csv) {
    if (r.given("range"))
      throw UserError(r.where("range"), "'range' is of air from a tape7, and there is none", "'tape7' beside it", "remove 'range', or add 'tape7: FILE'");
    return false;
  }
  const char* kind = tape7 ? "tape7" : "csv";
  for (const char* other : {"csv", "library", "table", "extinction"})
    if (std::string(other) != kind && r.given(other))
      throw UserError(r.where(other), std::string("the air is given twice, by '") + kind + "' and by '" + other + "'",
                      "one of library, table, extinction, tape7 and csv", "remove one");
  for (const char* key : {"temperature", "radiance", "top", "visibility", "aerosol"})
    if (r.given(key))
      throw UserError(r.where(key), std::string("'") + key + "' is of another kind of air: what this air is and sends is in its file",
                      std::string("'") + kind + "'" + (tape7 ? ", and 'range' where the file has none" : " alone"), std::string("remove '") + key + "'");
  if (csv && r.given("range"))
    throw UserError(r.where("range"), "'range' is of a tape7: a CSV file has its ranges in it", "ranges in a column or in the names of columns",
                    "remove 'range'");
  if (csv) {
    simulation_.path = pathOf(readAirCsv(tableFile(r, "csv", base_, "a CSV table of air")));
    return true;
  }
  const auto runs = readTape7(tableFile(r, "tape7", base_, "a tape7 of MODTRAN"));
  simulation_.path = pathOf(tabulatedAir(runs, r.given("range") ? std::optional(r.number("range")) : std::nullopt));
  return true;
}

}  // namespace pitviper
