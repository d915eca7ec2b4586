#include "sim/render/visible_lights.hpp"

#include <cmath>

namespace pitviper {

std::vector<double> apparentIntensity(const Simulation& sim, const Plan& plan, const WorldState& state, size_t light, const glm::dvec3& from) {
  const glm::dvec3 line = state.lights[light] - from;
  const double range = glm::length(line);
  double air = 0.0;
  if (plan.terms.air) {
    const double radius = sim.frame.earthRadius_m();
    const double sinElevation = range > 0.0 ? glm::dot(line, glm::normalize(from + glm::dvec3(0, 0, radius))) / range : 0.0;
    air = sim.path->airLength_m(sim.frame.height(from), sinElevation, range, radius);
  }
  std::vector<double> sums(static_cast<size_t>(plan.slotCount), 0.0);
  for (size_t i = 0; i < plan.node_um.size(); ++i) {
    const double w = plan.node_um[i];
    const double intensity = state.lightLevels[light] * sim.lights[light].intensity(w) * (plan.terms.air ? sim.path->transmittance(w, air) : 1.0);
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += plan.weight[s][i] * intensity;
  }
  return sums;
}

void addVisibleLights(Subpixels& image, const Simulation& sim, const Plan& plan, const WorldState& state) {
  const View& v = image.view();
  for (size_t l = 0; l < sim.lights.size(); ++l) {
    if (!sim.lights[l].visible || state.lightLevels[l] <= 0.0) continue;
    const glm::dvec3 p = glm::transpose(v.localFromCamera) * (state.lights[l] - v.position);
    if (-p.z < v.near_m) continue;
    const glm::dvec2 at = filmPosition(v, p);
    if (at.x < 0.0 || at.y < 0.0 || at.x >= v.width || at.y >= v.height) continue;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    const size_t pixel = image.index(x, y);
    if (-p.z > image.axialDepth_m(pixel)) continue;
    // As radiance: the flux divided by the aperture and the subpixel's projected solid angle.
    const double r2 = glm::dot(p, p), cosPsi = -p.z / std::sqrt(r2);
    const auto sums = apparentIntensity(sim, plan, state, l, v.position);
    for (size_t s = 0; s < sums.size(); ++s) image.add(s, pixel, sums[s] * cosPsi / r2 / image.projectedSolidAngle_sr(x, y));
  }
}

}  // namespace pitviper
