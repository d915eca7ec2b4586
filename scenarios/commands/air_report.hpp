#pragma once
// What an air table holds, for people: transmittance of a few paths in words, as CSV and as a chart.
#include <string>
#include <vector>

#include "atmosphere/absorber_table.hpp"
#include "scenarios/commands/charts.hpp"

namespace pitviper {

/// Title, source, range of wavelengths, and band means of transmittance over level and slant paths.
std::string describeAir(const AbsorberTable& air);
/// Transmittance of the same paths and path radiance of the level ones at every 20 1/cm.
std::string airCsv(const AbsorberTable& air);
std::vector<Chart> airCharts(const AbsorberTable& air);

}  // namespace pitviper
