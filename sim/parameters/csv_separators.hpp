#pragma once
// Tables of other countries' spreadsheets: semicolons or tabs between cells, commas for decimal points.
#include <cstddef>
#include <string>
#include <string_view>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// UserError where semicolons, or tabs alone, part the cells of a line of a CSV file.
void refuseOtherSeparators(std::string_view line, const Location& where);

/// What to do about a row of `found` cells below a header of `wanted`: more of them may be decimal commas.
std::string fixOfCells(std::size_t found, std::size_t wanted);

}  // namespace pitviper
