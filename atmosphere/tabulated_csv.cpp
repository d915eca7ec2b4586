#include "atmosphere/tabulated_csv.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

#include "atmosphere/csv_rows.hpp"
#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr std::uintmax_t kLargestFile = 64u << 20;  // as many rows as are read, of 130 characters
constexpr size_t kLongestLine = 65536;

}  // namespace

TabulatedAir readAirCsv(std::istream& in, const std::string& name) {
  std::optional<csv::Rows> rows;
  std::string line;
  int number = 0;
  const auto fail = [&](const std::string& wrong, const std::string& expected, const std::string& fix) {
    throw UserError({name, std::max(number, 1), 1, -1}, wrong, expected, fix);
  };
  while (std::getline(in, line)) {
    ++number;
    if (line.size() > kLongestLine) fail("a line of more than 65536 characters", "a row of a table", "check that this is the file you mean");
    if (number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0) line.erase(0, 3);  // as spreadsheets write it
    const size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const Location where{name, number, 1, -1};
    if (rows) {
      refuseOtherSeparators(line, where);
      rows->add(csv::cellsOf(line), number, static_cast<int>(line.size()));
      continue;
    }
    auto columns = csv::namesOf(line, where);
    csv::requireAir(columns, where);
    rows.emplace(name, std::move(columns), number);
  }
  if (in.bad()) fail("the file cannot be read to its end", "", "");
  if (!rows) fail("the file is empty", "a line with the names of columns: wavelength_um, range_km, transmittance", "see atmosphere/tabulated_csv.hpp");
  return rows->make();
}

TabulatedAir readAirCsv(const std::filesystem::path& file) {
  std::istringstream in(readWholeFile(file, {.what = "a file of comma-separated values", .mostBytes = kLargestFile, .fix = "check its name"}));
  return readAirCsv(in, file.string());
}

}  // namespace pitviper
