#pragma once
// Columns of numbers below lines of words, as instruments and spectral libraries write them.
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// How cells are told apart: by blanks or tabs, semicolons or commas; and whether a comma is a decimal point.
enum class CellStyle { Blanks, Semicolons, Commas, BlanksDecimalComma, SemicolonsDecimalComma };

struct NumberRow {
  std::vector<double> values;
  int line = 0;
};

struct NumberLines {
  std::vector<std::string> head;  ///< the lines above the numbers, in UTF-8
  std::vector<NumberRow> rows;    ///< of equally many values; of one where the file has one column
  CellStyle style = CellStyle::Blanks;
};

/// Cells of a line, without blanks and quotes about them.
std::vector<std::string_view> cellsOf(std::string_view line, CellStyle style);

/// Numbers from the first line on that has two of them at least (or one, where no line has two), or below a mark such as "#DATA" or "Begin Spectral Data", to
/// the end or a mark such as "##END". UserError at its own line for a line of words among them, for rows of other lengths, and where decimal commas and commas
/// or groups of thousands cannot be told apart. `rows` is empty where the file has none.
NumberLines readNumberLines(const std::string& text, const std::string& file);

/// In UTF-8, lines ending in \n: ISO 8859-1 is turned into it, a mark of the order of bytes left out. UserError for UTF-16.
std::string asUtf8Lines(const std::string& text, const std::string& file);

}  // namespace pitviper
