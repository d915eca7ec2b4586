#include "sim/world/ground.hpp"

#include "sim/radiometry/physics.hpp"

namespace pitviper {

std::optional<Hit> groundHit(const Simulation& sim, const glm::dvec3& origin, const glm::dvec3& direction) {
  if (!sim.ground) return std::nullopt;
  const double range = physics::groundRange(sim.frame.height(origin), glm::dot(direction, sim.frame.up(origin)), sim.frame.earthRadius_m());
  if (range >= physics::kFar) return std::nullopt;
  Hit hit;
  hit.distance = range;
  hit.point = origin + range * direction;
  hit.normal = hit.facet = sim.frame.up(hit.point);
  return hit;
}

bool hiddenByGround(const Simulation& sim, const RayHits& hits, const glm::dvec3& origin, const glm::dvec3& direction, double distance_m) {
  if (hits.solid.entity >= 0) return false;
  const std::optional<Hit> ground = groundHit(sim, origin, direction);
  return ground && ground->distance < distance_m * (1.0 - 1e-6);
}

const Surface& surfaceAt(const Simulation& sim, const Hit& hit) {
  return hit.entity < 0 ? *sim.ground : sim.entities[static_cast<size_t>(hit.entity)].surfaces[static_cast<size_t>(hit.surface)];
}

double temperatureAt(const Simulation& sim, const WorldState& state, const Hit& hit) {
  return hit.entity < 0 ? sim.ground->temperature_K : state.temperatures_K[static_cast<size_t>(hit.entity)][static_cast<size_t>(hit.surface)];
}

}  // namespace pitviper
