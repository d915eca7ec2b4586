#pragma once
// What programs that write columns of numbers say about them at the head of their files.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/csv_columns.hpp"

namespace pitviper {

struct ColumnHeader {
  std::vector<csv::Column> columns;  ///< their places are those in the line
  int line = 1;                      ///< that says it
  size_t rows = 0;                   ///< index of the first line that may be a row; 0 where there is no header
};

/// LBLRTM's or uvspec's header, tabulated_columns.hpp; none where there is neither. Errors: UserError for quantities that are no air along a path.
std::optional<ColumnHeader> columnHeader(const csv::Lines& lines, const std::string& file);
bool hasColumnHeader(const csv::Lines& lines);
/// Index of the line behind LBLRTM's header, 0 where there is none.
size_t rowsBelowHeader(const csv::Lines& lines);

}  // namespace pitviper
