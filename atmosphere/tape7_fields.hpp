#pragma once
// Fortran's fixed columns: numbers stand at the right edge of their columns, may touch their neighbours, and may be blank.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/tape7.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper::tape7 {

/// A line of a file, its end cut off. Columns count from 1.
struct Line {
  std::string_view text;
  const std::string* file;
  int number;

  Location at(int column) const { return {*file, number, column, -1}; }
  std::string_view cut(int first, int last) const;
  /// Without blanks at either end.
  std::string_view trimmed() const;
};

struct Field {
  int first = 1, last = 1;
  std::string name;
  Tape7Quantity quantity = Tape7Quantity::Unknown;
};

std::string_view trim(std::string_view text);
/// A piece of a file as it may stand in a message: short, printable, in quotes.
std::string inQuotes(std::string_view text);

/// The number in a field, or none where it is blank. Errors: UserError saying what else stands there.
std::optional<double> numberIn(const Line& line, const Field& field);
std::optional<int> integerIn(const Line& line, const Field& field);

/// The lines of a file. Errors: UserError for an empty file and for bytes that are not text.
std::vector<Line> linesOf(std::string_view text, const std::string& file);

}  // namespace pitviper::tape7
