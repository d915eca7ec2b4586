#include "sim/parameters/csv_table.hpp"

#include <algorithm>
#include <string_view>

#include "sim/parameters/csv_separators.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

struct Cell {
  std::string_view text;
  int column;  ///< of its first character
};

std::vector<Cell> cellsOf(std::string_view line) {
  std::vector<Cell> all;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    all.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = end + 1;
  }
  return all;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string_view::npos ? "" : std::string(text.substr(first, last - first + 1));
}

CsvColumn columnOf(const Cell& cell, std::size_t number, Location where) {
  const std::size_t open = cell.text.find('['), close = cell.text.rfind(']');
  const bool named = open != std::string_view::npos && close != std::string_view::npos && close > open;
  where.column = cell.column + static_cast<int>(open == std::string_view::npos ? 0 : open);
  if (!named)
    throw UserError(where, "the header names no unit in column " + std::to_string(number), "a header such as 'wavelength [um], transmittance [1]'",
                    "write the units in brackets");
  return {trimmed(cell.text.substr(0, open)), std::string(cell.text.substr(open + 1, close - open - 1)), where};
}

}  // namespace

CsvTable readCsvTable(const std::filesystem::path& file, const FileWanted& wanted, std::size_t mostRows, const Location& askedAt) {
  const std::string bytes = readWholeFile(file, wanted, askedAt);
  CsvTable table;
  table.file = file.string();
  std::string_view rest = bytes;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);  // as spreadsheets write it
  for (Location where{table.file, 1, 1, -1}; !rest.empty(); ++where.line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line[0] == '#') continue;
    const auto cells = cellsOf(line);
    refuseOtherSeparators(line, where);
    if (table.columns.empty()) {
      for (const Cell& cell : cells) table.columns.push_back(columnOf(cell, table.columns.size() + 1, where));
      continue;
    }
    const std::size_t wantedCells = table.columns.size();
    if (cells.size() != wantedCells)
      throw UserError(where, "a row of " + std::to_string(cells.size()) + " cells", std::to_string(wantedCells) + ", as the header has columns",
                      fixOfCells(cells.size(), wantedCells));
    for (const Cell& cell : cells) {
      const auto q = splitQuantity(cell.text);
      if (!q || !q->unit.empty())
        throw UserError({table.file, where.line, cell.column, -1}, "not a finite number: " + tokenOf(cell.text), "a number", "correct or remove the line");
      table.values.push_back(q->value);
    }
    table.lines.push_back(where.line);
    if (table.rows() > mostRows)
      throw UserError(where, "the table goes on after " + std::to_string(mostRows) + " rows", "at most that many", "thin the table out");
  }
  if (table.columns.empty())
    throw UserError({table.file, 1, 1, -1}, "the file is empty", "a header and rows", "write 'wavelength [um], value [1]' and rows under it");
  return table;
}

}  // namespace pitviper
