#pragma once
// How finely a plan tells light that the air scatters more than once.
#include "sim/plan/line_check.hpp"

namespace pitviper {

/// Streams: the fewest whose loss keeps budget::kStreams on lines of the film and others; none where all of that light is less than budget::kTerms. That and
/// what it loses go into the plan. `fine`: all wavelengths. `floor`: filmFloors().
void chooseStreams(const Simulation& simulation, const Plan& fine, SightRays& rays, const std::vector<double>& floor, Plan& plan);

}  // namespace pitviper
