#pragma once
// What a table of air holds, for people: how it was made and how well it fits, in words, as CSV and as charts.
#include <string>
#include <vector>

#include "atmosphere/tabulated_air.hpp"
#include "scenarios/commands/charts.hpp"

namespace pitviper {

/// How it was made, wavelengths, ranges, fit and mean transmittance by range.
std::string describeTable(const TabulatedAir& air);
/// At the table's own wavelengths: the coefficients, transmittance and path radiance at several ranges, the sky where it is known.
std::string tableCsv(const TabulatedAir& air);
std::vector<Chart> tableCharts(const TabulatedAir& air);

}  // namespace pitviper
