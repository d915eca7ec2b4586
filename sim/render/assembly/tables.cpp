#include "sim/render/assembly/tables.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>

#include "sim/radiance/node_surroundings.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/assembly/material_tables.hpp"
#include "sim/render/assembly/node_loops.hpp"

namespace pitviper {
namespace {

/// What a surface of a temperature sends by itself (simple: emission and the dome's light), or the black body of its temperature (general).
float selfOf(const SurfaceTables& t, const Simulation& sim, const Plan& plan, const SpectralNode& n, const Surface& surface, double temperature_K) {
  if (t.general) return static_cast<float>(n.planck(temperature_K));
  const Material& m = sim.materialOf(surface);
  return static_cast<float>(n.mean([&](double w) {
    const double ambient = plan.terms.ambient ? (*sim.ambient)(w) : 0.0;
    return m.emissivity(w, 0.0) * physics::planckRadiance(w, temperature_K) + (ambient > 0.0 ? m.reflectance(w, 0.0) * ambient : 0.0);
  }));
}

/// The row of a surface, or of the background, which shines by itself (null).
std::uint32_t appendRow(SurfaceTables& t, const Simulation& sim, const Plan& plan, const Surface* surface) {
  const size_t begin = t.rows.size(), nodes = plan.nodes.size();
  const auto at = static_cast<std::uint32_t>(begin / (t.packed() ? 4 : 4 * static_cast<size_t>(t.vectors)));
  if (surface && !t.packed())
    for (const SpectralNode& n : plan.nodes)
      appendComponents(t.rows, t, sim.materialOf(*surface), 0.0,
                       [&](std::size_t k) { return n.mean([&](double w) { return sim.materialOf(*surface).reflections[k]->column(w, 0.0, 0.0); }); });
  t.rows.resize(begin + 4 * t.texelsOfRow(), 0.0f);
  for (size_t i = 0; i < nodes; ++i) {
    const SpectralNode& n = plan.nodes[i];
    t.rows[t.selfAt(at, i)] =
        surface ? selfOf(t, sim, plan, n, *surface, surface->temperature_K) : static_cast<float>(n.mean([&](double w) { return sim.background(w); }));
  }
  return at;
}

/// Means over groups of wavelengths have no closed form: a table from the coldest to the hottest texel, see temperature_tabulated.glsl.
void appendPlanck(SurfaceTables& t, const Simulation& sim, const Plan& plan) {
  double coldest = INFINITY, hottest = 0.0;
  for (const Entity& e : sim.entities)
    for (const Surface& s : e.surfaces)
      if (s.temperatureTexture >= 0)
        for (float texel : sim.textures[static_cast<size_t>(s.temperatureTexture)].texels) {
          coldest = std::min(coldest, static_cast<double>(texel));
          hottest = std::max(hottest, static_cast<double>(texel));
        }
  coldest = std::max(coldest, 1.0);
  hottest = std::max(hottest, coldest * (1.0 + 1e-6));
  const double first = 1.0 / hottest, step = (1.0 / coldest - first) / (kPlanckEntries - 1);
  t.planckAt = static_cast<long long>(t.rows.size() / 4);
  t.rows.insert(t.rows.end(), {static_cast<float>(first), static_cast<float>(1.0 / step), 0.0f, 0.0f});
  for (int k = 0; k < kPlanckEntries; ++k) {
    for (const SpectralNode& n : plan.nodes) t.rows.push_back(static_cast<float>(n.planck(1.0 / (first + step * k))));
    t.rows.resize((t.rows.size() + 3) / 4 * 4, 0.0f);
  }
}

float sourceOf(const Medium& medium, const SpectralNode& n, double temperature_K) {
  return static_cast<float>(n.mean([&](double w) { return medium.source(w, temperature_K); }));
}

/// Where a medium's source radiance of a node stands; its absorption is four before.
size_t sourceAt(std::uint32_t row, size_t node) { return 4 * row + 8 * (node / 4) + 4 + node % 4; }

std::uint32_t appendMedium(RenderTables& t, const Plan& plan, const Medium& medium, const Surface& surface) {
  const auto row = static_cast<std::uint32_t>(t.media.size() / 4);
  t.media.resize(t.media.size() + 8 * ((plan.nodes.size() + 3) / 4), 0.0f);
  for (size_t i = 0; i < plan.nodes.size(); ++i) {
    t.media[sourceAt(row, i) - 4] = static_cast<float>(plan.nodes[i].absorption_per_m[static_cast<size_t>(surface.material)]);
    t.media[sourceAt(row, i)] = sourceOf(medium, plan.nodes[i], surface.temperature_K);
  }
  return row;
}

/// Nodes that feed the same groups of channels.
struct Loop {
  int first = 0, count = 0;
  std::vector<int> groups;
  bool lit = false;
};

/// Neighbouring blocks of nodes that feed the same groups in one loop each; `apart`: those that light does not matter to by themselves.
std::vector<Loop> loopsOf(const Plan& plan, bool apart) {
  std::vector<Loop> loops;
  for (const auto& block : plan.blocks) {
    Loop loop{block.first, block.count, {}, block.lit};
    for (int s : block.slots)
      if (std::find(loop.groups.begin(), loop.groups.end(), s / 4) == loop.groups.end()) loop.groups.push_back(s / 4);
    if (loops.empty() || loops.back().groups != loop.groups || (apart && loops.back().lit != loop.lit)) {
      loops.push_back(loop);
      continue;
    }
    loops.back().count += loop.count;
    loops.back().lit |= loop.lit;
  }
  return loops;
}

/// Each loop holds the whole radiance once more, and a driver's time to compile grows steeply with their number (Mesa: 0.35 s with 10, 20 s
/// with 16): beyond four, one loop feeds all groups, with weights of 0.
std::vector<Loop> integrationLoops(const Plan& plan) {
  constexpr size_t kMostLoops = 4;
  for (bool apart : {true, false})
    if (auto loops = loopsOf(plan, apart); loops.size() <= kMostLoops) return loops;
  Loop all{0, plan.nodeCount(), {}, true};
  for (int g = 0; g < plan.groupCount(); ++g) all.groups.push_back(g);
  return {all};
}

/// Loops over nodes with so many terms in all are written out, which llvmpipe draws by a tenth to a third faster; longer ones would take it seconds to
/// compile (2 s for 288).
constexpr int kMostWrittenOut = 128;

/// Each weight that is not 0 by itself, four to an entry.
void writeOut(const Plan& plan, const auto& weightOf, const auto& call, std::ostream& text, std::vector<float>& weights) {
  for (const Loop& loop : loopsOf(plan, true))
    for (int node = loop.first; node < loop.first + loop.count; ++node) {
      text << call(loop) << node << ");\n";
      for (int g : loop.groups)
        for (int k = 0; k < 4; ++k) {
          const float w = weightOf(g, k, node);
          if (w == 0.0f) continue;
          const size_t at = weights.size();
          if (at % 4 == 0) text << "  vec4 w" << at / 4 << " = weights(" << at / 4 << ");\n";
          text << "  channels" << g << "[" << k << "] += w" << at / 4 << "[" << at % 4 << "] * radiance;\n";
          weights.push_back(w);
        }
    }
  weights.resize((weights.size() + 3) / 4 * 4);
}

void writeLoops(const Plan& plan, const auto& weightOf, const auto& call, std::ostream& text, std::vector<float>& weights) {
  for (const Loop& loop : integrationLoops(plan)) {
    text << "  for (int i = 0; i < " << loop.count << "; ++i) {\n" << call(loop) << loop.first << " + i);\n";
    for (size_t k = 0; k < loop.groups.size(); ++k)
      text << "  channels" << loop.groups[k] << " += weights(" << weights.size() / 4 << " + i * " << loop.groups.size() << " + " << k << ") * radiance;\n";
    text << "  }\n";
    for (int node = loop.first; node < loop.first + loop.count; ++node)
      for (int g : loop.groups)
        for (int k = 0; k < 4; ++k) weights.push_back(weightOf(g, k, node));
  }
}

void writeIntegral(RenderTables& t, const Plan& plan) {
  std::ostringstream targets, text;
  targets << "void clearTargets() {\n";
  for (int g = 0; g < plan.groupCount(); ++g) targets << "  channels" << g << " = vec4(0.0);\n";
  targets << "}\n";
  text << "void integrate() {\n  Real radiance;\n";
  t.writtenOut = plan.nodeCount() * (1 + (plan.terms.lights ? plan.lightCount * t.solid.vectors : 0)) <= kMostWrittenOut &&
                 (!plan.terms.lights || plan.lightCount <= kFewLights || plan.nodeCount() <= kMostLoopsWrittenOut);
  const auto weightOf = [&plan](int group, int k, int node) {
    const size_t slot = static_cast<size_t>(4 * group + k);
    return slot < plan.weight.size() ? static_cast<float>(plan.weight[slot][static_cast<size_t>(node)]) : 0.0f;
  };
  const auto call = [&plan](const Loop& loop) { return std::string("  radiance = nodeRadiance") + (loop.lit && plan.terms.lights ? "(" : "Unlit("); };
  if (t.writtenOut) writeOut(plan, weightOf, call, text, t.weights);
  else writeLoops(plan, weightOf, call, text, t.weights);
  text << "}\n";
  t.targetsText = targets.str();
  t.integrateText = text.str();
}

}  // namespace

int lightGroups(const Simulation& sim, const Plan& plan) { return plan.lightCount == 0 ? 0 : (plan.lightCount + (sim.sunShade ? 1 : 0) + 3) / 4; }

std::vector<float> lightTable(const Simulation& sim, const Plan& plan, const WorldState& state) {
  const size_t groups = static_cast<size_t>(lightGroups(sim, plan));
  std::vector<float> table(plan.nodes.size() * groups * 4, 0.0f);
  if (plan.lightCount == 0) return table;
  for (size_t i = 0; i < plan.nodes.size(); ++i) {
    const SpectralNode& n = plan.nodes[i];
    for (size_t l = 0; l < sim.lights.size(); ++l)
      table[i * groups * 4 + l] = static_cast<float>(state.lightLevels[l] > 0.0 ? state.lightLevels[l] * n.mean(sim.lights[l].intensity) : 0.0);
    if (sim.sun) table[i * groups * 4 + sim.lights.size()] = static_cast<float>(n.mean(sim.sun->irradiance));
    if (sim.sunShade)
      table[i * groups * 4 + static_cast<size_t>(plan.lightCount)] = static_cast<float>(n.absorption_per_m[static_cast<size_t>(sim.sunShade->material)]);
  }
  return table;
}

std::vector<std::uint32_t> SurfaceTables::packedMaterials() const {
  std::vector<std::uint32_t> words;
  const auto put = [&words](const auto& four) {
    for (auto v : four) words.push_back(std::bit_cast<std::uint32_t>(v));
  };
  for (const GpuMaterial& m : materials) {
    put(m.counts), put(m.kinds), put(m.scale), put(m.transmission), put(m.state), put(m.stateScale), put(m.second), put(m.response);
    for (const auto& c : m.components) put(c);
    for (const auto& l : m.lobes) put(l);
    for (const auto& i : m.images) put(i);
  }
  return words;
}

std::vector<DrawItem> drawItems(const Simulation& sim) {
  std::vector<DrawItem> items{{DrawKind::Background, -1, -1}};
  if (sim.ground) items.push_back({DrawKind::Ground, -1, -1});
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    const Entity& entity = sim.entities[e];
    const bool medium = sim.mediumOf(entity);
    for (size_t s = 0; s < (medium ? 1 : entity.surfaces.size()); ++s) {
      const Surface& surface = entity.surfaces[s];
      const DrawKind kind = medium ? DrawKind::Medium : sim.materialOf(surface).transmission ? DrawKind::Layer : DrawKind::Solid;
      items.push_back({kind, static_cast<int>(e), static_cast<int>(s), 0, 0, surface.temperature_K});
    }
  }
  return items;
}

RenderTables makeTables(const Simulation& sim, const Plan& plan) {
  RenderTables t;
  if (plan.terms.surroundings > 0) t.around = std::make_shared<const NodeSurroundings>(sim, plan.nodes, plan.terms.surroundings);
  t.solid.general = plan.terms.solid.isGeneral();
  t.layer.general = plan.terms.layer.isGeneral();
  t.solid.nodes = t.layer.nodes = plan.nodes.size();
  t.solid.lit = plan.terms.lights;
  t.layer.lit = plan.terms.lights && plan.terms.layer.reflects;
  for (const auto& m : sim.materials) {
    int& vectors = m->transmission ? t.layer.vectors : t.solid.vectors;
    vectors = std::max(vectors, (static_cast<int>(m->reflections.size()) + 2) / 3);
  }
  std::vector<std::uint32_t> at;  // of each material in the tables of its kind
  for (const auto& m : sim.materials) {
    SurfaceTables& kind = m->transmission ? t.layer : t.solid;
    at.push_back(static_cast<std::uint32_t>(kind.materials.size()));
    if (!m->medium) appendMaterial(kind, sim, *m, (m->transmission ? plan.terms.layer : plan.terms.solid).lobes, plan, t.around.get());
  }
  const auto background = static_cast<std::uint32_t>(t.solid.materials.size());
  appendMaterial(t.solid, sim, Material{}, {}, plan, nullptr);  // black: its row is its radiance

  t.draws = drawItems(sim);
  for (DrawItem& d : t.draws) {
    const Surface* surface = d.kind == DrawKind::Ground ? &*sim.ground
                             : d.entity < 0             ? nullptr
                                                        : &sim.entities[static_cast<size_t>(d.entity)].surfaces[static_cast<size_t>(d.surface)];
    if (d.kind == DrawKind::Medium) {
      d.row = appendMedium(t, plan, *sim.mediumOf(sim.entities[static_cast<size_t>(d.entity)]), *surface);
      continue;
    }
    d.row = appendRow(d.kind == DrawKind::Layer ? t.layer : t.solid, sim, plan, surface);
    d.material = surface ? at[static_cast<size_t>(surface->material)] : background;
  }
  for (size_t d = 0; d < t.draws.size(); ++d)
    if (t.draws[d].kind == DrawKind::Ground) t.ground = static_cast<int>(d);

  for (const SpectralNode& n : plan.nodes) {
    const double w = n.members.front().wavelength_um;
    t.node.push_back(static_cast<float>(n.air.extinction[0]));
    t.node.push_back(static_cast<float>(n.air.source));
    t.node.push_back(static_cast<float>(kSecondRadiation_umK / w));
    t.node.push_back(static_cast<float>(kFirstRadianceConstant / std::pow(w, 5)));
    // Rows of simple surfaces hold the dome's light already.
    if (plan.terms.ambient && plan.terms.surroundings == 0 && (t.solid.general || t.layer.general))
      t.ambient.insert(t.ambient.end(), {static_cast<float>(n.mean(*sim.ambient)), 0.0f, 0.0f, 0.0f});
  }
  const bool groups = std::any_of(plan.nodes.begin(), plan.nodes.end(), [](const SpectralNode& n) { return !n.isWavelength(); });
  if (groups && plan.terms.solid.temperatureTextures) appendPlanck(t.solid, sim, plan);
  if (groups && plan.terms.layer.temperatureTextures) appendPlanck(t.layer, sim, plan);
  writeIntegral(t, plan);
  return t;
}

bool updateTemperatures(RenderTables& tables, const Simulation& sim, const Plan& plan, const WorldState& state) {
  bool changed = false;
  for (DrawItem& d : tables.draws) {
    if (d.entity < 0) continue;
    const double now_K = state.temperatures_K[static_cast<size_t>(d.entity)][static_cast<size_t>(d.surface)];
    if (now_K == d.temperature_K) continue;
    d.temperature_K = now_K;
    changed = true;
    const Entity& entity = sim.entities[static_cast<size_t>(d.entity)];
    SurfaceTables& t = d.kind == DrawKind::Layer ? tables.layer : tables.solid;
    for (size_t i = 0; i < plan.nodes.size(); ++i) {
      const SpectralNode& n = plan.nodes[i];
      if (d.kind == DrawKind::Medium) tables.media[sourceAt(d.row, i)] = sourceOf(*sim.mediumOf(entity), n, now_K);
      else t.rows[t.selfAt(d.row, i)] = selfOf(t, sim, plan, n, entity.surfaces[static_cast<size_t>(d.surface)], now_K);
    }
  }
  return changed;
}

}  // namespace pitviper
