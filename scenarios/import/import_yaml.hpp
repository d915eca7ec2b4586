#pragma once
// Pieces of YAML that importers print: what they write is read back as it was.
#include <string>
#include <string_view>
#include <vector>

namespace pitviper {

/// As few digits as give the same number back.
std::string exactNumber(double value);

/// To twelve digits: of one that a change of unit has rounded.
double tidy(double value);

/// In double quotes, on one line: UTF-8 as it is (bytes that are none as of ISO 8859-1), control characters as blanks, quotes and backslashes escaped.
std::string quotedText(std::string_view text);

/// Rows of numbers in brackets, a few to a line.
std::string rowsOfNumbers(const std::vector<std::vector<double>>& rows);

}  // namespace pitviper
