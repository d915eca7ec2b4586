#include "sim/render/shadow_demand.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

double shadowedSubpixels(const Simulation& sim, const WorldState& state, const View& view, std::size_t caster, std::size_t light) {
  const Pose& pose = state.entities[caster];
  const double all = static_cast<double>(view.width) * view.height, radius = static_cast<double>(sim.entities[caster].boundingRadius_m);
  const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(sim.entities[caster].boundingCentre);
  const bool sun = light == sim.lights.size();
  const glm::dvec3 from = sun ? sim.sun->toSun : state.lights[light] - centre;
  const double away = glm::length(from);
  if (!sun && !(away > radius)) return all;
  // What it shades lies on and around a ray away from the light, which from a lamp widens.
  const glm::dvec3 line = -from / away;
  const double along = std::max(glm::dot(view.position - centre, line), 0.0);
  const double wide = sun ? radius : radius * (away + along) / (away - radius), nearest = glm::length(view.position - centre - along * line);
  if (!(nearest > 2.0 * wide)) return all;
  return std::min(kPi * wide * wide / (nearest * nearest * view.tanPerPixelX * view.tanPerPixelY), all);
}

}  // namespace pitviper
