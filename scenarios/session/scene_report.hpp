#pragma once
// What a scene is and shows, in words: as `check` and `plan` tell it.
#include <string>

#include "sim/model/simulation.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

/// For each camera its size, layers, lens and detector; what it sees of each body in the first, middle and last frame; and notes.
std::string sceneText(const Simulation& simulation);

/// What a camera's plan chose: one JSON object, or as people read it.
std::string planText(const Simulation& simulation, const Camera& camera, const Plan& plan, bool asJson);

}  // namespace pitviper
