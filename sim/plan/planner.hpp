#pragma once
// Chooses a plan's wavelengths for what a scene shows: makePlan() with groups of wavelengths in the place of samples.
#include "sim/plan/sights.hpp"

namespace pitviper {

/// A plan for what a camera or a probe sees. With an accuracy in its spectral settings: groups of wavelengths that integrate lines of sight drawn at
/// random within it, their error on others found (Plan::predictedError). Without: makePlan(). Throws what makePlan() throws.
Plan planFor(const Simulation& simulation, const Eye& eye);

}  // namespace pitviper
