#pragma once
// The ground under a scene: where a line of sight that meets no body and goes down ends.
#include <optional>

#include "sim/world/ray_hits.hpp"

namespace pitviper {

/// The earth's sphere at height 0 as a ray meets it (from below it: at once), entity -1, or none where the scene has no ground or the ray passes it
/// by. Bodies are seen before it even where they reach below the sphere. direction of unit length.
std::optional<Hit> groundHit(const Simulation& simulation, const glm::dvec3& origin, const glm::dvec3& direction);

/// Whether the ground stands before a place on a line of sight: where no body does, which would be seen before it.
bool hiddenByGround(const Simulation& simulation, const RayHits& hits, const glm::dvec3& origin, const glm::dvec3& direction, double distance_m);

/// What a hit is the surface of: an entity's, or the ground.
const Surface& surfaceAt(const Simulation& simulation, const Hit& hit);

/// Its temperature [K], where no texture says.
double temperatureAt(const Simulation& simulation, const WorldState& state, const Hit& hit);

}  // namespace pitviper
