#include "sim/model/glint.hpp"

#include <algorithm>

namespace pitviper {
namespace {

/// Exponent of a lobe from which it is sharp: half a hemisphere wide.
constexpr double kSharp = 4.0;

}  // namespace

std::size_t countLights(const Simulation& sim) { return sim.lights.size() + (sim.sun ? 1 : 0); }

double glintOf(const Simulation& sim, const WorldState& state, const Hit& hit, const glm::dvec3& direction, std::size_t light) {
  if (hit.entity < 0) return 0.0;
  const Surface& surface = sim.entities[static_cast<size_t>(hit.entity)].surfaces[static_cast<size_t>(hit.surface)];
  double sum = 0.0;
  for (const auto& r : sim.materialOf(surface).reflections) {
    if (!(r->lobeExponent() > kSharp)) continue;
    const glm::dvec3 line = light < sim.lights.size() ? state.lights[light] - hit.point : sim.sun->toSun;
    const double distance = glm::length(line), cosine = distance > 0.0 ? glm::dot(line, hit.normal) / distance : 0.0;
    if (!(cosine > 0.0)) return 0.0;
    glm::dvec3 view = inNormalFrame(hit.normal, -direction);
    view.z = std::max(view.z, 1e-6);
    sum += cosine * r->lobe(inNormalFrame(hit.normal, line / distance), view) / r->lobeMaximum();
  }
  return sum;
}

}  // namespace pitviper
