#include "sim/render/shadow/shadow_demand.hpp"

#include <algorithm>
#include <cmath>

#include "sim/scene/triangle_tree.hpp"

namespace pitviper {

double shadowedSubpixels(const Simulation& sim, const WorldState& state, const View& view, std::size_t caster, const ShadowBox& box, std::size_t light,
                         double nearest_m) {
  const double all = static_cast<double>(view.width) * view.height, radius = box.radius_m();
  const Pose& pose = state.entities[caster];
  const glm::dvec3 centre = pose.position + pose.orientation * box.centre(), size = box.high - box.low;
  const bool sun = light == sim.lights.size();
  const glm::dvec3 from = sun ? sim.sun->toSun : state.lights[light] - centre;
  const double away = glm::length(from);
  if (!sun && !(away > radius)) return all;
  // What it shades lies on and around a ray away from the light, which from a lamp widens.
  const glm::dvec3 line = -from / away;
  const double along = std::max(glm::dot(view.position - centre, line), 0.0);
  const double wider = sun ? 1.0 : (away + along) / (away - radius);
  const double nearest = std::max(glm::length(view.position - centre - along * line), nearest_m);
  if (!(nearest > 2.0 * wider * radius)) return all;
  const double area_m2 = 0.5 * (size.x * size.y + size.y * size.z + size.z * size.x) * wider * wider;
  return std::min(area_m2 / (nearest * nearest * view.tanPerPixelX * view.tanPerPixelY), all);
}

double distanceTo(const ShadowBox& box, const Pose& body, const glm::dvec3& place) {
  const glm::dvec3 at = glm::conjugate(body.orientation) * (place - body.position);
  return glm::length(at - glm::clamp(at, box.low, box.high));
}

double distanceToShadow(const Simulation& sim, const WorldState& state, const glm::dvec3& eye, const glm::dvec3& centre, double radius_m, std::size_t light,
                        std::size_t field) {
  const bool sun = light == sim.lights.size();
  const glm::dvec3 away = sun ? -sim.sun->toSun : glm::normalize(centre - state.lights[light]);
  const Pose& pose = state.entities[field];
  const glm::dquat turned = glm::conjugate(pose.orientation);
  const auto& mesh = sim.entities[field].mesh;
  const glm::dvec3 origin = turned * (centre - pose.position), direction = turned * away;
  double nearest = INFINITY;
  treeOf(mesh)->along(origin, direction, 0.0, nearest, [&](std::uint32_t t) {
    const TriangleMeeting m = meetTriangle(*mesh, t, origin, direction);
    if (m.met && m.along > 0.0) nearest = std::min(nearest, m.along);
    return false;
  });
  // It is a little wider than the caster, and longer where the light is low.
  constexpr double kLonger = 4.0;
  return nearest < INFINITY ? glm::length(centre + nearest * away - eye) - kLonger * radius_m : INFINITY;
}

}  // namespace pitviper
