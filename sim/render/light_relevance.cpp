#include "sim/render/light_relevance.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Half a unit in the last place of a float.
constexpr double kRounding = 6e-8;

}  // namespace

LightRelevance::LightRelevance(const Simulation& simulation, const Plan& plan, const RenderTables& tables)
    : simulation_(simulation), ratio_(simulation.entities.size() * simulation.lights.size(), 0.0) {
  for (const DrawItem& d : tables.draws) {
    if (d.kind != DrawKind::Solid && d.kind != DrawKind::Layer) continue;
    const Material& material = simulation.materialOf(simulation.entities[static_cast<size_t>(d.entity)].surfaces[static_cast<size_t>(d.surface)]);
    const SurfaceTables& t = d.kind == DrawKind::Layer ? tables.layer : tables.solid;
    for (size_t l = 0; t.lit && l < simulation.lights.size(); ++l) {
      double& worst = ratio_[static_cast<size_t>(d.entity) * simulation.lights.size() + l];
      for (size_t i = 0; i < plan.nodes.size() && std::isfinite(worst); ++i) {
        // Tables over angles and textures have no bound at hand: such bodies are lit by every light that shines.
        const float* row = t.general ? nullptr : &t.rows[4 * static_cast<size_t>(t.vectors) * (d.row + i)];
        double most = row ? 0.0 : INFINITY;
        for (size_t k = 0; row && k < material.reflections.size(); ++k) most += static_cast<double>(row[4 * (k / 3) + k % 3]) * material.reflections[k]->lobe().maximum;
        const double reflected = most * plan.nodes[i].mean(simulation.lights[l].intensity);
        if (reflected > 0.0) worst = std::max(worst, row && row[3] > 0.0f ? reflected / static_cast<double>(row[3]) : INFINITY);
      }
    }
  }
}

bool LightRelevance::matters(std::size_t entity, std::size_t light, const WorldState& state) const {
  const double ratio = state.lightLevels[light] * ratio_[entity * simulation_.lights.size() + light];
  if (!(ratio > 0.0)) return false;
  const Entity& e = simulation_.entities[entity];
  const Pose& pose = state.entities[entity];
  const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(e.boundingCentre);
  const double nearest = std::max(glm::length(state.lights[light] - centre) - static_cast<double>(e.boundingRadius_m), simulation_.lights[light].radius_m);
  return ratio / (nearest * nearest) >= kRounding / static_cast<double>(simulation_.lights.size());
}

}  // namespace pitviper
