#include "sim/render/light_relevance.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Half a unit in the last place of a float.
constexpr double kRounding = 6e-8;

double reflectionOf(double most, double self) { return most > 0.0 ? (self > 0.0 ? most / self : INFINITY) : 0.0; }

/// Least and largest texel; those of 1 where there is no texture.
std::pair<double, double> rangeOf(const Simulation& sim, int texture) {
  if (texture < 0) return {1.0, 1.0};
  const auto& texels = sim.textures[static_cast<size_t>(texture)].texels;
  const auto [low, high] = std::minmax_element(texels.begin(), texels.end());
  return {static_cast<double>(*low), static_cast<double>(*high)};
}

/// Most of a point light's intensity that a surface sends on at each node, by the radiance that it has itself, at its least: f_max / S.
class Bounds {
 public:
  Bounds(const Simulation& sim, const Plan& plan, const RenderTables& tables) : sim_(sim), plan_(plan), tables_(tables) {}

  std::vector<double> of(const DrawItem& d) const {
    const SurfaceTables& t = d.kind == DrawKind::Layer ? tables_.layer : tables_.solid;
    const Surface& surface = sim_.entities[static_cast<size_t>(d.entity)].surfaces[static_cast<size_t>(d.surface)];
    return t.general ? ofTables(d, t, surface) : ofRow(d, t, sim_.materialOf(surface));
  }

 private:
  std::vector<double> ofRow(const DrawItem& d, const SurfaceTables& t, const Material& material) const {
    std::vector<double> bound;
    for (size_t i = 0; i < plan_.nodes.size(); ++i) {
      const float* row = &t.rows[4 * static_cast<size_t>(t.vectors) * (d.row + i)];
      double most = 0.0;
      for (size_t k = 0; k < material.reflections.size(); ++k) most += static_cast<double>(row[4 * (k / 3) + k % 3]) * material.reflections[k]->lobe().maximum;
      bound.push_back(reflectionOf(most, static_cast<double>(row[3])));
    }
    return bound;
  }

  /// Of tables over angles and states, and of textures, their ends. Beside what the surface emits at its coldest there is what it reflects of ambient light:
  /// of that and of the lamp each component takes its share, whatever the textures say, so that the greatest ratio of a component is that of all.
  std::vector<double> ofTables(const DrawItem& d, const SurfaceTables& t, const Surface& surface) const {
    const Material& material = sim_.materialOf(surface);
    const GpuMaterial& g = t.materials[d.material];
    const size_t nodes = plan_.nodes.size(), each = static_cast<size_t>(4 * t.vectors), states = static_cast<size_t>(g.state[1]);
    const double coldest_K = surface.temperatureTexture >= 0 ? rangeOf(sim_, surface.temperatureTexture).first : d.temperature_K;
    const double emitted = g.kinds[2] == 1 ? 1.0 : std::max(rangeOf(sim_, g.transmission[2]).first, 0.0);
    std::vector<double> bound, greatest;  // of each component's texture
    for (const auto& c : g.components) greatest.push_back(std::max(rangeOf(sim_, c[1]).second, 0.0));
    for (size_t i = 0; i < nodes; ++i) {
      const auto ends = [&](const std::vector<float>& table, size_t first, size_t entries, size_t place) {
        double low = INFINITY, high = 0.0;
        for (size_t e = 0; e < entries; ++e) {
          const double value = static_cast<double>(table[4 * first + (e * nodes + i) * each + place]);
          low = std::min(low, value), high = std::max(high, value);
        }
        return std::pair(low, high);
      };
      double most = 0.0, byAmbient = 0.0;
      for (size_t k = 0; k < material.reflections.size(); ++k) {
        const size_t place = 4 * (k / 3) + k % 3;
        const double own = ends(t.columns, g.counts[3], states * g.counts[0] * g.counts[1], place).second * material.reflections[k]->lobe().maximum;
        most += own * greatest[k];
        byAmbient = std::max(byAmbient, reflectionOf(own, ends(t.hemispherical, g.kinds[3], states * g.counts[2], place).first));
      }
      const double self = emitted * ends(t.hemispherical, g.kinds[3], states * g.counts[2], 3).first * plan_.nodes[i].planck(coldest_K);
      const double ambient = plan_.terms.ambient ? plan_.nodes[i].mean(*sim_.ambient) : 0.0;
      bound.push_back(std::min(reflectionOf(most, self), ambient > 0.0 ? byAmbient / ambient : most > 0.0 ? INFINITY : 0.0));
    }
    return bound;
  }

  const Simulation& sim_;
  const Plan& plan_;
  const RenderTables& tables_;
};

}  // namespace

LightRelevance::LightRelevance(const Simulation& simulation, const Plan& plan, const RenderTables& tables)
    : simulation_(simulation), accuracy_(plan.accuracy), ratio_(simulation.entities.size() * simulation.lights.size(), 0.0) {
  const Bounds bounds(simulation, plan, tables);
  for (const DrawItem& d : tables.draws) {
    if ((d.kind != DrawKind::Solid && d.kind != DrawKind::Layer) || simulation.lights.empty()) continue;
    if (!(d.kind == DrawKind::Layer ? tables.layer : tables.solid).lit) continue;
    const auto bound = bounds.of(d);
    for (size_t l = 0; l < simulation.lights.size(); ++l) {
      double& worst = ratio_[static_cast<size_t>(d.entity) * simulation.lights.size() + l];
      for (size_t i = 0; i < bound.size(); ++i)
        if (const double intensity = plan.nodes[i].mean(simulation.lights[l].intensity); intensity > 0.0 && bound[i] > 0.0)
          worst = std::max(worst, intensity * bound[i]);
    }
  }
}

double LightRelevance::nearest2_m2(std::size_t entity, std::size_t light, const WorldState& state) const {
  const Entity& e = simulation_.entities[entity];
  const Pose& pose = state.entities[entity];
  const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(e.boundingCentre);
  const double nearest = std::max(glm::length(state.lights[light] - centre) - static_cast<double>(e.boundingRadius_m), simulation_.lights[light].radius_m);
  return nearest * nearest;
}

bool LightRelevance::matters(std::size_t entity, std::size_t light, const WorldState& state) const {
  const double strength = strength_m2(entity, light, state);
  return strength > 0.0 && strength / nearest2_m2(entity, light, state) >= share(kRounding);
}

double LightRelevance::shadowReach2_m2(std::size_t entity, std::size_t light, const WorldState& state) const {
  return std::min(strength_m2(entity, light, state) / share(std::max(kRounding, kShadowShare * accuracy_)), physics::kFar);
}

bool LightRelevance::shadowMatters(std::size_t entity, std::size_t light, const WorldState& state) const {
  return nearest2_m2(entity, light, state) < shadowReach2_m2(entity, light, state);
}

}  // namespace pitviper
