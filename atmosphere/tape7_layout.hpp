#pragma once
// Where the columns of a tape7 stand, and what they hold: from the lines with their names.
#include <vector>

#include "atmosphere/tape7_fields.hpp"

namespace pitviper::tape7 {

/// What to do about several lines of sight in one run.
inline constexpr const char* kOneLineOfSight =
    "run MODTRAN with each line of sight as a case of its own, one after the other in one tape5: its tape7 has a run for each";

/// A line of column names begins with the wavenumber's, or with what some outputs have instead.
bool isNames(const Line& line);

struct Layout {
  std::vector<Field> fields;  ///< the first is the wavenumber, the second the total transmittance
  int nameLines = 1;
};

/// `lines[at]` is the line with the names. Errors: UserError if they are not those of a run of this kind.
Layout layoutOf(Tape7Kind kind, const std::vector<Line>& lines, size_t at);

}  // namespace pitviper::tape7
