#include "atmosphere/modtran_files.hpp"

#include "atmosphere/modtran_csv.hpp"
#include "atmosphere/modtran_json.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

/// A run of 5000 1/cm by 1 1/cm has 1 MB.
constexpr std::uintmax_t kLargestFile = 64u << 20;

struct Format {
  bool (*is)(std::string_view text);
  std::vector<Tape7Run> (*parse)(std::string_view text, const std::string& name);
};

// A tape7 last: it has no mark of its own, and its reader says best what a file is not.
constexpr Format kFormats[] = {{isModtranJson, parseModtranJson}, {isModtranCsv, parseModtranCsv}, {[](std::string_view) { return true; }, parseTape7}};

}  // namespace

std::vector<Tape7Run> parseModtran(std::string_view text, const std::string& name) {
  for (const Format& format : kFormats)
    if (format.is(text)) return format.parse(text, name);
  return {};
}

std::vector<Tape7Run> readModtran(const std::filesystem::path& path) {
  return parseModtran(readWholeFile(path, {.what = "a tape7 of MODTRAN, or its JSON or CSV", .mostBytes = kLargestFile, .fix = "check its name"}),
                      path.string());
}

}  // namespace pitviper
