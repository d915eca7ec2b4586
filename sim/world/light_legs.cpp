#include "sim/world/light_legs.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/world/sun_legs.hpp"

namespace pitviper {

SunHere sunHere(const Simulation& sim, const glm::dvec3& point) {
  SunHere here{sim.sun->toSun, 1.0, {}};
  if (!sim.overEarth()) return here;
  const glm::dvec3 up = sim.frame.up(point);
  const double sine = glm::dot(here.toSun, up), height = sim.frame.height(point);
  const RisenSun risen = risenSun(height, sine, sim.frame.earthRadius_m());
  here.share = risen.share;
  // Turned upwards by the sine's change over the cosine twice: once for the angle, once for what of `up` lies across the line.
  here.toSun = glm::normalize(here.toSun + (risen.sinElevation - sine) / std::max(1.0 - sine * sine, 1e-6) * up);
  if (here.share > 0.0 && sim.air->top_m() < physics::kFar) here.air = sim.air->amounts({height, risen.sinElevation, sim.frame.earthRadius_m()}, physics::kFar);
  return here;
}

double patternTowards(const Simulation& sim, const WorldState& state, std::size_t light, const glm::dvec3& direction) {
  const LightPattern& pattern = sim.lights[light].pattern;
  return pattern.body ? pattern.body(pattern.parameters, glm::inverse(state.lightPoses[light].orientation) * direction) : 1.0;
}

std::size_t lampOf(const Simulation& sim, std::size_t light) { return sim.lights[light].lamp >= 0 ? static_cast<std::size_t>(sim.lights[light].lamp) : light; }

LightLeg lightLeg(const Simulation& sim, const WorldState& state, const Hit& hit, std::size_t light) {
  LightLeg leg;
  if (light == sim.lights.size()) {
    const SunHere sun = sunHere(sim, hit.point);
    leg.toLight = sun.toSun;
    leg.distance_m = INFINITY;
    leg.factor = sun.share * std::max(glm::dot(sun.toSun, hit.normal), 0.0);
    leg.air = sun.air;
    return leg;
  }
  const glm::dvec3 line = state.lights[light] - hit.point;
  const double d2 = glm::dot(line, line);
  leg.distance_m = std::sqrt(d2);
  leg.toLight = d2 > 0.0 ? line / leg.distance_m : hit.normal;
  leg.factor = physics::pointIrradianceFactor(glm::dot(leg.toLight, hit.normal), d2, sim.lights[light].radius_m);
  if (leg.factor > 0.0) leg.factor *= patternTowards(sim, state, light, -leg.toLight);
  if (!sim.air || !sim.air->traits().any) return leg;
  leg.air = sim.air->amounts({sim.frame.height(hit.point), glm::dot(leg.toLight, sim.frame.up(hit.point)), sim.frame.earthRadius_m()}, leg.distance_m);
  return leg;
}

glm::dvec3 inNormalFrame(const glm::dvec3& normal, const glm::dvec3& direction) {
  const glm::dvec3 helper = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
  return {glm::dot(direction, x), glm::dot(direction, y), glm::dot(direction, normal)};
}

}  // namespace pitviper
