#pragma once
// How finely a plan tells ambient light by direction.
#include "sim/plan/line_check.hpp"

namespace pitviper {

/// Of the accuracy, the part that ambient light may lose by being told with fewer harmonics. It changes evenly over surfaces, and needs no margin.
constexpr double kSurroundingsShare = 0.4;

/// Ambient light by direction costs: the fewest harmonics, or none but the mean, that lose no more than a part of the accuracy on lines of the film and others;
/// else as many as there are. That and what it loses go into the plan. `fine`: with light from all around in full. `floor`: filmFloors().
void chooseSurroundings(const Simulation& simulation, const NodesOfPlan& fine, SightRays& rays, const std::vector<double>& floor, Plan& plan);

}  // namespace pitviper
