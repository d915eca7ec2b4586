#include "sim/model/light_legs.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {

LightLeg lightLeg(const Simulation& sim, const WorldState& state, const Hit& hit, std::size_t light) {
  const bool sun = light == sim.lights.size();
  LightLeg leg;
  double d2 = 1.0;
  if (sun) {
    leg.toLight = sim.sun->toSun;
    leg.distance_m = INFINITY;
  } else {
    const glm::dvec3 line = state.lights[light] - hit.point;
    d2 = glm::dot(line, line);
    leg.distance_m = std::sqrt(d2);
    leg.toLight = d2 > 0.0 ? line / leg.distance_m : hit.normal;
  }
  const double cosine = glm::dot(leg.toLight, hit.normal);
  leg.factor = sun ? std::max(cosine, 0.0) : physics::pointIrradianceFactor(cosine, d2, sim.lights[light].radius_m);
  if (!sim.path || sim.path->isNone() || (sun && sim.path->top_m() >= physics::kFar)) return leg;
  const AirRay ray{sim.frame.height(hit.point), glm::dot(leg.toLight, sim.frame.up(hit.point)), sim.frame.earthRadius_m()};
  leg.air = sim.path->amounts(ray, sun ? physics::kFar : leg.distance_m);
  return leg;
}

glm::dvec3 inNormalFrame(const glm::dvec3& normal, const glm::dvec3& direction) {
  const glm::dvec3 helper = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
  return {glm::dot(direction, x), glm::dot(direction, y), glm::dot(direction, normal)};
}

}  // namespace pitviper
