#pragma once
// Two readings of one scenario whose bodies are the same on a GPU.
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Whether what was uploaded of one's meshes and textures, and found of what light passes through them, serves the other.
bool sameBodies(const Simulation& a, const Simulation& b);
/// Whether what was found of one's air, ground and light from all around serves the other.
bool sameAir(const Simulation& a, const Simulation& b);

}  // namespace pitviper
