#pragma once
// How finely a plan tells ambient light by direction.
#include "sim/plan/line_check.hpp"

namespace pitviper {

/// Ambient light by direction costs: the fewest harmonics, or none but the mean, that lose no more than budget::kSurroundings on lines of the film and others;
/// else as many as there are. That and what it loses go into the plan. `fine`: with light from all around in full. `floor`: filmFloors().
void chooseSurroundings(const Simulation& simulation, const NodesOfPlan& fine, SightRays& rays, const std::vector<double>& floor, Plan& plan);

}  // namespace pitviper
