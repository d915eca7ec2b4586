#include "sim/camera/visible_lights.hpp"

#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/world/ground.hpp"
#include "sim/world/light_legs.hpp"

namespace pitviper {

std::vector<double> apparentIntensity(const Simulation& sim, const Plan& plan, const WorldState& state, size_t light, const glm::dvec3& from,
                                      const std::vector<double>& way) {
  const glm::dvec3 line = state.lights[light] - from;
  const double range = glm::length(line), sent = state.lightLevels[light] * (range > 0.0 ? patternTowards(sim, state, light, -line / range) : 1.0);
  AirAmounts air;
  if (plan.terms.air)
    air = sim.air->amounts({sim.frame.height(from), range > 0.0 ? glm::dot(line, sim.frame.up(from)) / range : 0.0, sim.frame.earthRadius_m()}, range);
  std::vector<double> sums(static_cast<size_t>(plan.slotCount), 0.0);
  for (size_t i = 0; i < plan.nodes.size(); ++i) {
    const SpectralNode& n = plan.nodes[i];
    const double intensity = way[i] * sent * n.mean(sim.lights[light].intensity) * (plan.terms.air ? sim.air->transmittance(n.air, air) : 1.0);
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += plan.weight[s][i] * intensity;
  }
  return sums;
}

WaysToLights::WaysToLights(const Simulation& simulation, const Plan& plan) : simulation_(simulation), terms_(plan.terms), plan_(plan) {
  terms_.air = terms_.scatteredSun = false;
}

std::vector<double> WaysToLights::from(const WorldState& state, const std::vector<char>& present, const glm::dvec3& place, const glm::dvec3& direction,
                                       double distance_m, double near_m) const {
  LineOfSight line{place, direction, castRay(simulation_, state, place, direction, near_m, &present), 0.0};
  if (line.hits.solid.entity >= 0 && line.hits.solid.distance < distance_m * (1.0 - 1e-6)) return {};
  // The sun's direction is to the part of it that stands above the horizon.
  if (distance_m < physics::kFar && hiddenByGround(simulation_, line.hits, place, direction, distance_m)) return {};
  if (line.hits.layers.empty() && line.hits.stretches.empty()) return std::vector<double>(plan_.nodes.size(), 1.0);
  if (!spectra_) spectra_ = std::make_unique<const NodeSpectra>(simulation_, plan_.nodes, terms_);
  NodeSum sum(*spectra_);
  sum.begin();
  wayAlong({simulation_, terms_, nullptr, state, {}}, line, distance_m, sum);
  return sum.transmittance();
}

bool lightIsInView(const Simulation& sim, const WorldState& state, const View& v, size_t light) {
  if (!sim.lights[light].visible || state.lightLevels[light] <= 0.0) return false;
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (state.lights[light] - v.position);
  if (-p.z < v.near_m) return false;
  const glm::dvec2 at = filmPosition(v, p);
  if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height)) return false;
  return !v.wanted || (*v.wanted)[static_cast<size_t>(at.y) * static_cast<size_t>(v.width) + static_cast<size_t>(at.x)];
}

void addVisibleLights(Subpixels& image, const WaysToLights& ways, const Simulation& sim, const Plan& plan, const WorldState& state,
                      const std::vector<char>& present) {
  const View& v = image.view();
  for (size_t l = 0; l < sim.lights.size(); ++l) {
    if (!lightIsInView(sim, state, v, l)) continue;
    const glm::dvec3 line = state.lights[l] - v.position, p = glm::transpose(v.localFromCamera) * line;
    const glm::dvec2 at = filmPosition(v, p);
    const double range = glm::length(line);
    const auto way = ways.from(state, present, v.position, line / range, range, v.near_m * range / -p.z);
    if (way.empty()) continue;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    // As radiance: the flux divided by the aperture and the subpixel's projected solid angle.
    const auto sums = apparentIntensity(sim, plan, state, l, v.position, way);
    const double perIntensity = (-p.z / range) / (range * range), area_sr = image.projectedSolidAngle_sr(x, y);
    for (size_t s = 0; s < sums.size(); ++s) {
      if (image.keepsPoints()) image.addPoint(at, image.index(x, y), s, sums[s] * perIntensity);
      else image.add(s, image.index(x, y), sums[s] * perIntensity / area_sr);
    }
  }
}

}  // namespace pitviper
