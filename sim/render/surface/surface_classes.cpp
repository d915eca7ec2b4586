#include "sim/render/surface/surface_classes.hpp"

#include <algorithm>
#include <cmath>

#include "sim/render/assembly/node_loops.hpp"
#include "sim/render/surface/surface_slots.hpp"

namespace pitviper {
namespace {

/// Whether all columns are albedo / pi to rounding.
bool isLambertian(const GpuMaterial& m, const SurfaceTables& t) {
  constexpr float kRounding = 1e-6f, kInversePi = 0.31830989f;
  if (!t.lit || !t.general) return true;
  if (m.counts[0] > 1 || m.counts[2] > 1) return false;
  const std::size_t all = static_cast<std::size_t>(m.state[1]) * t.nodes * static_cast<std::size_t>(t.vectors);
  for (std::size_t n = 0; n < 4 * all; ++n) {
    if (n % 4 == 3) continue;
    const float column = t.columns[4 * m.counts[3] + n], albedo = kInversePi * t.hemispherical[4 * m.kinds[3] + n];
    if (std::abs(column - albedo) > kRounding * std::abs(column)) return false;
  }
  return true;
}

SurfaceClass classOf(const DrawItem& item, const Simulation& sim, const SurfaceTables& tables) {
  SurfaceClass c;
  const GpuMaterial& m = tables.materials[item.material];
  c.emissionModifiers = m.transmission[2] >= 0;
  c.modifiers = c.emissionModifiers || m.transmission[0] >= 0;
  c.viewAngles = m.counts[2] > 1;
  c.columns = !isLambertian(m, tables);
  for (std::size_t k = 0; k < m.components.size(); ++k) {
    const auto& component = m.components[k];
    if (component[2] != 0) c.components = static_cast<int>(k) + 1;
    c.lobes |= component[0] > 0;
    c.modifiers |= component[1] >= 0;
  }
  c.tabulated = m.counts[0] > 1;
  c.states = m.state[1] > 1;
  c.around = m.response[2] > 1;
  c.modifiers |= c.states;  // read as they are
  const Surface& surface =
      item.kind == DrawKind::Ground ? *sim.ground : sim.entities[static_cast<size_t>(item.entity)].surfaces[static_cast<size_t>(item.surface)];
  c.temperatureTextures = surface.temperatureTexture >= 0;
  return c;
}

SurfaceClass both(SurfaceClass a, const SurfaceClass& b) {
  a.modifiers |= b.modifiers;
  a.emissionModifiers |= b.emissionModifiers;
  a.viewAngles |= b.viewAngles;
  a.columns |= b.columns;
  a.components = std::max(a.components, b.components);
  a.temperatureTextures |= b.temperatureTextures;
  a.lobes |= b.lobes;
  a.tabulated |= b.tabulated;
  a.states |= b.states;
  a.around |= b.around;
  return a;
}

/// Bodies that mostly shade themselves: a second program takes a driver as long to compile as their pixels would gain in many frames.
constexpr int kCostly = 2;

/// Which of the kinds that have a program of their own: the plainest, those with textures alone, all others.
int kindOf(const SurfaceClass& c) {
  if (c.viewAngles || c.columns || c.lobes || c.tabulated || c.states || c.around) return kCostly;
  return c.modifiers || c.temperatureTextures ? 1 : 0;
}

}  // namespace

std::vector<SurfaceClass> sortIntoClasses(RenderTables& tables, const Simulation& sim, const Plan& plan, bool truth, bool apart) {
  if (!apart)
    return {{.modifiers = true,
             .emissionModifiers = true,
             .viewAngles = true,
             .columns = true,
             .components = 3 * tables.solid.vectors,
             .temperatureTextures = true,
             .lobes = true,
             .tabulated = true,
             .states = true,
             .around = true}};
  std::vector<SurfaceClass> classes{{.sky = true}};
  for (DrawItem& item : tables.draws) {
    if (item.kind != DrawKind::Solid && item.kind != DrawKind::Ground) continue;
    const SurfaceClass own = classOf(item, sim, tables.solid);
    auto at = std::find_if(classes.begin() + 1, classes.end(), [&](const SurfaceClass& c) { return kindOf(c) == kindOf(own); });
    if (at == classes.end()) at = classes.insert(classes.end(), own);
    else *at = both(*at, own);
    item.surfaceClass = item.unshadowed = item.everyLight = static_cast<int>(at - classes.begin());
  }
  if (!lightsVary(plan, sim, truth)) return classes;
  const std::size_t all = classes.size();
  const bool unshadowed = shadowsVary(plan, sim, truth);
  std::vector<int> alone{0};
  for (std::size_t c = 1; c < all; ++c) {
    alone.push_back(static_cast<int>(kindOf(classes[c]) < kCostly ? classes.size() : c));
    if (alone.back() == static_cast<int>(c)) continue;
    classes.push_back(classes[c]);
    classes.back().sunAlone = true;
    if (!unshadowed) continue;
    classes.push_back(classes[c]);
    classes.back().unshadowed = true;
  }
  for (DrawItem& item : tables.draws) {
    item.surfaceClass = alone[static_cast<std::size_t>(item.everyLight)];
    if (unshadowed && item.surfaceClass != item.everyLight) item.unshadowed = item.surfaceClass + 1;  // light_demand.glsl counts on it
  }
  return classes;
}

bool lightsVary(const Plan& plan, const Simulation& sim, bool truth) {
  return (sim.sun || !truth) && plan.terms.lights && plan.lightCount > 0 && (plan.terms.shadows || plan.lightCount > 1);
}

bool shadowsVary(const Plan& plan, const Simulation& sim, bool truth) {
  return lightsVary(plan, sim, truth) && plan.terms.shadows && plan.lightCount > (sim.sun ? 1 : 0);
}

void addClassSlots(const SurfaceClass& own, const RenderTables& tables, ShaderSlots& slots) {
  slots.constants["SURFACES"] = own.sky ? 0 : 1;
  if (own.sky) {
    // The background's row is its radiance.
    slots.files["surface"] = surfaceShader(tables.solid.general || !tables.solid.lit ? "surface_unlit" : "surface_simple");
    slots.files["lights"] = surfaceShader("lights_none");
  }
  if (own.sunAlone) {
    slots.files["lights"] = surfaceShader(slots.constants["SUN"] > 0 ? "lights_sun" : "lights_none");
  }
  if (own.sunAlone || own.unshadowed) slots.files["shadow"] = "sim/render/shadow/glsl/shadow_none.glsl";
  if (!own.lobes) {
    slots.constants["LOBES"] = 0;
    if (tables.solid.lit) slots.generated["lobes"] = "Real lobeOf(int kind, Vec4 parameters, Vec3 toLight) { return 1.0; }\n";
  }
  if (!own.states) slots.constants["STATES"] = 0;
  if (!own.around && slots.constants.contains("AROUND_PLAIN")) slots.constants["AROUND_PLAIN"] = 1;
  slots.constants["USED_COMPONENTS"] = own.components;
  slots.constants["EMISSION_MODIFIERS"] = own.emissionModifiers ? 1 : 0;
  slots.constants["TRANSMISSION_MODIFIERS"] = 0;
  slots.constants["VIEW_ANGLES"] = own.viewAngles ? 1 : 0;
  if (tables.solid.lit && !own.columns) slots.files["columns"] = surfaceShader("columns_albedo");
  else if (!own.tabulated && tables.solid.lit) slots.files["columns"] = surfaceShader("columns_plain");
  if (!own.modifiers) slots.files["modifiers"] = surfaceShader("modifiers_none");
  if (!own.temperatureTextures) slots.files["temperature"] = surfaceShader("temperature_uniform");
  setLightLoops(slots);
}

}  // namespace pitviper
