#pragma once
// What a plan must hold for besides a scenario's own times: worlds of variations of it.
#include <memory>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

struct ExpectedWorld {
  std::shared_ptr<const Simulation> of;
  WorldState state;
};

/// The scene with a frame for each of the worlds, in the place of its own: planners look at these. Bodies, temperatures, light levels and cameras are as there;
/// lamps stay where the scene has them. Worlds of scenes with other bodies, lights or cameras are left out; where none is left the scene is as it was.
Simulation withFramesOf(const Simulation& simulation, const std::vector<ExpectedWorld>& worlds);

}  // namespace pitviper
