#include "sim/render/surface/light_relevance.hpp"

#include <algorithm>
#include <cmath>

#include "sim/plan/budget.hpp"
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

/// Least and largest value of a table at a node, of `entries` from `first` on.
std::pair<double, double> endsOf(const std::vector<float>& table, size_t first, size_t entries, size_t each, size_t nodes, size_t node, size_t place) {
  double low = INFINITY, high = 0.0;
  for (size_t e = 0; e < entries; ++e) {
    const double value = static_cast<double>(table[4 * first + (e * nodes + node) * each + place]);
    low = std::min(low, value), high = std::max(high, value);
  }
  return {low, high};
}

const SurfaceTables& tablesOf(const RenderTables& tables, const DrawItem& d) { return d.kind == DrawKind::Layer ? tables.layer : tables.solid; }

}  // namespace

LightRelevance::LightRelevance(const Simulation& simulation, const Plan& plan, const RenderTables& tables)
    : simulation_(simulation),
      nodes_(simulation.lights.empty() ? std::vector<SpectralNode>{} : plan.nodes),
      accuracy_(plan.accuracy),
      weight_(plan.weight),
      floor_(plan.darkFloors()) {
  if (!simulation.lights.empty()) sunshine_ = sunshineOf(plan);
  for (const auto& light : simulation.lights)
    for (const SpectralNode& n : nodes_) intensity_.push_back(n.mean(light.intensity));
  for (size_t d = 0; d < tables.draws.size() && !simulation.lights.empty(); ++d) {
    const DrawKind kind = tables.draws[d].kind;
    if ((kind == DrawKind::Solid || kind == DrawKind::Layer) && tablesOf(tables, tables.draws[d]).lit) parts_.push_back(partOf(plan, tables, d));
  }
  follow(tables);
}

/// Of tables over angles and states, and of textures, their ends. Beside what the surface emits at its coldest there is what it reflects of ambient light:
/// of that and of the lamp each component takes its share, whatever the textures say, so that the greatest ratio of a component is that of all.
LightRelevance::Part LightRelevance::partOf(const Plan& plan, const RenderTables& tables, std::size_t draw) const {
  const DrawItem& d = tables.draws[draw];
  const SurfaceTables& t = tablesOf(tables, d);
  const Surface& surface = simulation_.entities[static_cast<size_t>(d.entity)].surfaces[static_cast<size_t>(d.surface)];
  const auto& reflections = simulation_.materialOf(surface).reflections;
  const size_t each = static_cast<size_t>(4 * t.vectors);
  Part part;
  part.draw = draw;
  part.most.assign(nodes_.size(), 0.0);
  const bool alike =
      std::all_of(reflections.begin(), reflections.end(), [](const auto& r) { return r->lobe().function.empty() && r->axes()[0].angle == Angle::None; });
  if (alike) part.component.assign(reflections.size(), std::vector<double>(nodes_.size(), 0.0));
  const auto placeOf = [](size_t k) { return 4 * (k / 3) + k % 3; };
  if (!t.general) {
    for (size_t i = 0; i < nodes_.size(); ++i)
      for (size_t k = 0; k < reflections.size(); ++k) {
        const double own = static_cast<double>(t.rows[each * (d.row + i) + placeOf(k)]) * reflections[k]->lobe().maximum;
        part.most[i] += own;
        if (alike) part.component[k][i] = own;
      }
    return part;
  }
  const GpuMaterial& g = t.materials[d.material];
  const size_t states = static_cast<size_t>(g.state[1]);
  if (surface.temperatureTexture >= 0) part.coldest_K = rangeOf(simulation_, surface.temperatureTexture).first;
  const double emitted = g.kinds[2] == 1 ? 1.0 : std::max(rangeOf(simulation_, g.transmission[2]).first, 0.0);
  std::vector<double> greatest;  // of each component's texture
  for (const auto& c : g.components) greatest.push_back(std::max(rangeOf(simulation_, c[1]).second, 0.0));
  if (states > 1) part.component.clear();
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const auto hemispherical = [&](size_t place) { return endsOf(t.hemispherical, g.kinds[3], states * g.counts[2], each, nodes_.size(), i, place).first; };
    double byAmbient = 0.0;
    for (size_t k = 0; k < reflections.size(); ++k) {
      const auto mostIn = [&](size_t first, size_t entries) { return endsOf(t.columns, first, states * entries, each, nodes_.size(), i, placeOf(k)).second; };
      double own = mostIn(g.counts[3], size_t{g.counts[0]} * g.counts[1]);
      if (g.second[0] > 1) own = std::max(own, mostIn(g.second[3], size_t{g.second[0]} * g.second[1]));
      own *= reflections[k]->lobe().maximum;
      part.most[i] += own * greatest[k];
      if (!part.component.empty()) part.component[k][i] = own;
      byAmbient = std::max(byAmbient, reflectionOf(own, hemispherical(placeOf(k))));
    }
    const double ambient = plan.terms.ambient && plan.terms.surroundings == 0 ? nodes_[i].mean(*simulation_.ambient) : 0.0;
    part.emissivity.push_back(emitted * hemispherical(3));
    part.byAmbient.push_back(ambient > 0.0 ? byAmbient / ambient : part.most[i] > 0.0 ? INFINITY : 0.0);
  }
  return part;
}

double LightRelevance::reflection(const Part& part, std::size_t node, const RenderTables& tables) const {
  const DrawItem& d = tables.draws[part.draw];
  if (part.emissivity.empty()) {
    const SurfaceTables& t = tablesOf(tables, d);
    return reflectionOf(part.most[node], static_cast<double>(t.rows[t.selfAt(d.row, node)]));
  }
  return std::min(reflectionOf(part.most[node], part.emissivity[node] * nodes_[node].planck(part.coldest_K.value_or(d.temperature_K))), part.byAmbient[node]);
}

double LightRelevance::ratioOf(const std::vector<double>& most, const std::vector<double>& self, size_t light, size_t at) const {
  const double* intensity = &intensity_[light * nodes_.size()];
  if (!(accuracy_ > 0.0)) return reflectionOf(most[at] * intensity[at], self[at]);
  double sent = 0.0, own = 0.0;
  for (size_t i = 0; i < nodes_.size(); ++i) sent += weight_[at][i] * most[i] * intensity[i], own += weight_[at][i] * self[i];
  return reflectionOf(sent, std::max(own, floor_[at]));
}

double LightRelevance::inSunshineOf(const Part& part, size_t light, size_t slot) const {
  if (sunshine_.empty() || part.component.empty()) return INFINITY;
  double worst = 0.0;
  for (const auto& f : part.component) {
    double lamp = 0.0, sun = 0.0;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const double own = weight_[slot][i] * f[i];
      lamp += own * intensity_[light * nodes_.size() + i], sun += own * sunshine_[i];
    }
    worst = std::max(worst, reflectionOf(lamp, sun));
  }
  return worst;
}

void LightRelevance::follow(const RenderTables& tables) {
  const size_t lights = simulation_.lights.size();
  ratio_.assign(simulation_.entities.size() * lights, 0.0);
  inSunshine_ = ratio_;
  for (const Part& part : parts_) {
    std::vector<double> self(nodes_.size(), 0.0);
    for (size_t i = 0; i < nodes_.size(); ++i)
      if (const double reflected = reflection(part, i, tables); reflected > 0.0) self[i] = part.most[i] / reflected;
    for (size_t l = 0; l < lights; ++l) {
      const size_t at = static_cast<size_t>(tables.draws[part.draw].entity) * lights + l;
      for (size_t k = 0; k < (accuracy_ > 0.0 ? weight_.size() : nodes_.size()); ++k) {
        const double inShade = ratioOf(part.most, self, l, k);
        ratio_[at] = std::max(ratio_[at], inShade);
        inSunshine_[at] = std::max(inSunshine_[at], accuracy_ > 0.0 ? std::min(inShade, inSunshineOf(part, l, k)) : inShade);
      }
    }
  }
}

/// On a place that lies as kSunlit says.
std::vector<double> LightRelevance::sunshineOf(const Plan& plan) const {
  if (!simulation_.sun || !plan.terms.lights) return {};
  const double sine = glm::dot(simulation_.sun->toSun, simulation_.frame.up(glm::dvec3(0.0)));
  if (simulation_.overEarth() && !(sine > kSunlit)) return {};
  AirAmounts way;
  if (simulation_.air) way = simulation_.air->powered(simulation_.air->amounts({0.0, sine, simulation_.frame.earthRadius_m()}, physics::kFar));
  std::vector<double> all;
  for (const SpectralNode& n : nodes_)
    all.push_back(kSunlit * n.mean(simulation_.sun->irradiance) * (simulation_.air ? std::exp(-Atmosphere::depthOf(n.air, way)) : 1.0));
  return all;
}

double LightRelevance::nearest2_m2(std::size_t entity, std::size_t light, const WorldState& state) const {
  const Entity& e = simulation_.entities[entity];
  const Pose& pose = state.entities[entity];
  const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(e.boundingCentre);
  const double nearest = std::max(glm::length(state.lights[light] - centre) - static_cast<double>(e.boundingRadius_m), simulation_.lights[light].radius_m);
  return nearest * nearest;
}

double LightRelevance::reach2_m2(std::size_t entity, std::size_t light, const WorldState& state, bool sunlit) const {
  return std::min(strength_m2(entity, light, state, sunlit) / share(std::max(kRounding, budget::kLamps.of(accuracy_))), physics::kFar);
}

bool LightRelevance::matters(std::size_t entity, std::size_t light, const WorldState& state) const {
  return nearest2_m2(entity, light, state) <= reach2_m2(entity, light, state);
}

double LightRelevance::shadowReach2_m2(std::size_t entity, std::size_t light, const WorldState& state) const {
  return std::min(strength_m2(entity, light, state) / share(std::max(kRounding, budget::kLampShadows.of(accuracy_))), physics::kFar);
}

bool LightRelevance::shadowMatters(std::size_t entity, std::size_t light, const WorldState& state) const {
  return nearest2_m2(entity, light, state) < shadowReach2_m2(entity, light, state);
}

}  // namespace pitviper
