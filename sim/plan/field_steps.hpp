#pragma once
// How many steps a line through a field is cut into, by the accuracy asked for.
#include "sim/plan/plan.hpp"

namespace pitviper {

/// Of each field and kind of its elements the fewest steps with which no channel's radiance on some lines through them, from the scenario's cameras and probes
/// over its time, is off by more than a third of the plan's accuracy from what many steps give; with no accuracy asked for: of 0.3 %. 0: nobody would notice
/// them.
std::vector<std::array<int, kFieldKinds>> fieldSteps(const Simulation& simulation, const Plan& plan);

}  // namespace pitviper
