#include "sim/parameters/csv_separators.hpp"

namespace pitviper {

void refuseOtherSeparators(std::string_view line, const Location& where) {
  const bool commas = line.find(',') != std::string_view::npos;
  const std::size_t semicolon = line.find(';'), at = semicolon == std::string_view::npos && !commas ? line.find('\t') : semicolon;
  if (at == std::string_view::npos) return;
  throw UserError({where.file, where.line, static_cast<int>(at) + 1, -1}, std::string(line[at] == ';' ? "semicolons" : "tabs") + " between the cells",
                  "commas (',') between cells and points for decimals: '3.6,0.5', not '3,6;0,5'",
                  "export the table so; or replace ',' by '.' where it is a decimal comma, then '" + std::string(line[at] == ';' ? ";" : "tab") + "' by ','");
}

std::string fixOfCells(std::size_t found, std::size_t wanted) {
  return found > wanted ? "write points for decimal commas (3.6, not 3,6), or remove cells" : "add cells";
}

}  // namespace pitviper
