#pragma once
// Whether a picture shows something that its plan was not made for.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// What is beyond the scenario's limits, in words ("jet at 31.2 km, planned to 20 km"), several after each other; empty: nothing, or no limits.
/// A body counts where it may be in view. Its range is that of its bounding sphere: beyond the farthest where all of it is farther, within the
/// nearest where all of it is nearer. Its temperature: of surfaces without a texture, whose own temperatures a plan looks at in any case.
std::string outsideLimits(const Simulation& simulation, const Camera& camera, const WorldState& state);

/// The limits themselves, in words: "bodies at 100 m to 20 km, at 250 K to 900 K, lights to level 1.5"; empty: none.
std::string describe(const Limits& limits);

}  // namespace pitviper
