#include "atmosphere/tabulated_columns.hpp"

#include <algorithm>
#include <charconv>

#include "atmosphere/column_headers.hpp"
#include "atmosphere/csv_rows.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

using csv::Cell;
using csv::Column;
using csv::Meaning;

constexpr std::uintmax_t kLargestFile = 64u << 20;

bool isNumber(const Cell& cell) {
  double v = 0.0;
  const auto [end, error] = std::from_chars(cell.text.data(), cell.text.data() + cell.text.size(), v);
  return end == cell.text.data() + cell.text.size();
}

bool has(const std::vector<Column>& columns, Meaning meaning) {
  return std::any_of(columns.begin(), columns.end(), [&](const Column& c) { return c.meaning == meaning; });
}

/// Columns without a range of their own get that of the path.
void giveRange(std::vector<Column>& columns, std::optional<double> range_m, const Location& where) {
  size_t without = 0;
  for (Column& c : columns) {
    if ((c.meaning != Meaning::Transmittance && c.meaning != Meaning::PathRadiance) || c.range_km) continue;
    ++without;
    if (range_m) c.range_km = 1e-3 * *range_m;
  }
  if (has(columns, Meaning::Range)) return;
  if (without > 0 && !range_m)
    throw UserError(where, "the file does not say over which range its columns hold", "the length of the path", "give the range with the file");
  if (without == 0 && range_m)
    throw UserError(where, "a range is given for columns that need none", "columns without a range of their own", "leave the range out");
}

/// Rows of numbers from a line on. Below a header there is nothing else; without one they begin where as many numbers stand as there are columns.
csv::Rows rowsOf(const csv::Lines& lines, const std::string& file, const ColumnHeader& header) {
  const std::vector<Column>& columns = header.columns;
  csv::Rows rows(file, columns, header.line);
  bool begun = header.rows > 0;
  std::optional<Location> other;  // numbers, but not as many as columns
  for (size_t i = header.rows; i < lines.size(); ++i) {
    const auto words = csv::wordsOf(lines[i]);
    if (words.empty() || words.front().text.front() == '#') continue;
    const bool numbers = std::all_of(words.begin(), words.end(), isNumber);
    // A row with one number spoilt is still a row.
    begun = begun || (words.size() == columns.size() && std::any_of(words.begin(), words.end(), isNumber));
    if (!begun && numbers && !other) other = {file, static_cast<int>(i) + 1, 1, -1};
    if (begun) rows.add(words, static_cast<int>(i) + 1, static_cast<int>(lines[i].size()));
  }
  if (!begun)
    throw UserError(other.value_or(Location{file, 1, 1, -1}), other ? "a row of other numbers than its columns" : "no rows of numbers",
                    std::to_string(columns.size()) + " numbers between blanks in each row", "name each column, '-' for those to be left out");
  return rows;
}

}  // namespace

bool isAirColumns(std::string_view text) { return hasColumnHeader(csv::linesOf(text)); }

TabulatedAir parseAirColumns(const ColumnText& file, const ColumnsWanted& wanted, const std::optional<ColumnText>& radiance) {
  const auto lines = csv::linesOf(file.text);
  std::optional<ColumnHeader> header;
  Location where = wanted.namesAt;
  if (wanted.names) header = ColumnHeader{csv::namesOf(*wanted.names, where), 0, rowsBelowHeader(lines)};
  else if ((header = columnHeader(lines, file.name))) where = {file.name, header->line, 1, -1};
  else
    throw UserError({file.name, 1, 1, -1}, "nothing says what the columns hold", "LBLRTM's header, uvspec's input behind '#' at the head of the file, or names",
                    "name the columns: \"wavenumber_1/cm, transmittance\"");
  giveRange(header->columns, wanted.range_m, where);
  csv::requireAir(header->columns, where);
  csv::Rows rows = rowsOf(lines, file.name, *header);
  if (!radiance) return rows.make();

  const auto others = csv::linesOf(radiance->text);
  auto other = columnHeader(others, radiance->name);
  const Location there{radiance->name, other ? other->line : 1, 1, -1};
  if (!other || !has(other->columns, Meaning::PathRadiance) || has(header->columns, Meaning::PathRadiance) || has(header->columns, Meaning::SourceRadiance))
    throw UserError(there,
                    !other || !has(other->columns, Meaning::PathRadiance) ? "no header says that this is a path radiance" : "the path radiance is there twice",
                    "LBLRTM's RADIANCE or uvspec's uu beside a file of transmittance", "leave it out, or put both into the columns of one file and name them");
  giveRange(other->columns, wanted.range_m, there);
  rows.join(rowsOf(others, radiance->name, *other));
  return rows.make();
}

TabulatedAir readAirColumns(const std::filesystem::path& file, const ColumnsWanted& wanted, const std::optional<std::filesystem::path>& radiance) {
  const auto read = [](const std::filesystem::path& path) {
    return ColumnText{readWholeFile(path, {.what = "a file of columns", .mostBytes = kLargestFile, .fix = "check its name"}), path.string()};
  };
  return parseAirColumns(read(file), wanted, radiance ? std::optional(read(*radiance)) : std::nullopt);
}

}  // namespace pitviper
