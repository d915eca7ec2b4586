#pragma once
// What an air table holds, for people: transmittance and radiance of a few paths, the sky and the sun, in words, as CSV and as charts.
#include <string>
#include <vector>

#include "atmosphere/absorber_table.hpp"
#include "scenarios/commands/charts.hpp"

namespace pitviper {

/// Title, source, range of wavelengths, and band means: transmittance and radiance over level and slant paths, sky, sun at the ground.
std::string describeAir(const AbsorberTable& air);
/// The same at every 20 1/cm.
std::string airCsv(const AbsorberTable& air);
std::vector<Chart> airCharts(const AbsorberTable& air);

}  // namespace pitviper
