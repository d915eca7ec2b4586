#include "sim/world/glint.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Exponent of a lobe from which it is sharp: half a hemisphere wide.
constexpr double kSharp = 4.0;

const Material& materialAt(const Simulation& sim, const Hit& hit) {
  return sim.materialOf(sim.entities[static_cast<size_t>(hit.entity)].surfaces[static_cast<size_t>(hit.surface)]);
}

/// Of unit length; none for a light that is out, or right there.
glm::dvec3 towards(const Simulation& sim, const WorldState& state, const Hit& hit, std::size_t light) {
  if (light == sim.lights.size()) return sim.sun->toSun;
  const glm::dvec3 line = state.lights[light] - hit.point;
  const double distance = glm::length(line);
  return state.lightLevels[light] > 0.0 && distance > 0.0 ? line / distance : glm::dvec3(0.0);
}

}  // namespace

std::size_t countLights(const Simulation& sim) { return sim.lights.size() + (sim.sun ? 1 : 0); }

bool isGlossy(const Simulation& sim, const Hit& hit) {
  if (hit.entity < 0) return false;
  const auto& reflections = materialAt(sim, hit).reflections;
  return std::any_of(reflections.begin(), reflections.end(), [](const auto& r) { return r->lobe().exponent > kSharp; });
}

double offMirror(const Simulation& sim, const WorldState& state, const Hit& hit, const glm::dvec3& direction, std::size_t light) {
  const glm::dvec3 to = towards(sim, state, hit, light);
  const double cosine = glm::dot(to, hit.normal);
  if (!(cosine > 0.0)) return INFINITY;
  const glm::dvec3 chord = 2.0 * cosine * hit.normal - to + direction;
  return 0.5 * glm::dot(chord, chord);
}

double glintOf(const Simulation& sim, const WorldState& state, const Hit& hit, const glm::dvec3& direction, std::size_t light) {
  if (!isGlossy(sim, hit)) return 0.0;
  const glm::dvec3 to = towards(sim, state, hit, light);
  const double cosine = glm::dot(to, hit.normal);
  if (!(cosine > 0.0)) return 0.0;
  glm::dvec3 view = inNormalFrame(hit.normal, -direction);
  view.z = std::max(view.z, 1e-6);
  double sum = 0.0;
  for (const auto& r : materialAt(sim, hit).reflections)
    if (r->lobe().exponent > kSharp) sum += cosine * r->lobeAt(inNormalFrame(hit.normal, to), view) / r->lobe().maximum;
  return sum;
}

}  // namespace pitviper
