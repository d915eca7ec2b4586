#pragma once
// How many steps a line through a field is cut into, by the accuracy asked for.
#include "sim/plan/plan.hpp"

namespace pitviper {

/// The fewest steps with which no channel's radiance on some lines through the field, from the scenario's cameras and probes over its time, is off by more
/// than a third of the plan's accuracy from what many steps give; with no accuracy asked for: of 0.3 %.
int fieldSteps(const Simulation& simulation, const Plan& plan, std::size_t field);

}  // namespace pitviper
