#include "sim/render/surface_classes.hpp"

#include <algorithm>

namespace pitviper {
namespace {

SurfaceClass classOf(const DrawItem& item, const Simulation& sim, const SurfaceTables& tables) {
  SurfaceClass c;
  const GpuMaterial& m = tables.materials[item.material];
  c.modifiers = std::max(m.transmission[0], m.transmission[2]) >= 0;
  for (const auto& component : m.components) {
    c.lobes |= component[0] > 0;
    c.modifiers |= component[1] >= 0;
  }
  c.tabulated = m.counts[0] > 1;
  c.states = m.state[0] >= 0;
  c.modifiers |= c.states;  // read as they are
  const Surface& surface =
      item.kind == DrawKind::Ground ? *sim.ground : sim.entities[static_cast<size_t>(item.entity)].surfaces[static_cast<size_t>(item.surface)];
  c.temperatureTextures = surface.temperatureTexture >= 0;
  return c;
}

SurfaceClass both(const SurfaceClass& a, const SurfaceClass& b) {
  return {
      false, a.modifiers || b.modifiers, a.temperatureTextures || b.temperatureTextures, a.lobes || b.lobes, a.tabulated || b.tabulated, a.states || b.states};
}

}  // namespace

std::vector<SurfaceClass> sortIntoClasses(RenderTables& tables, const Simulation& sim, bool apart) {
  if (!apart) return {{.modifiers = true, .temperatureTextures = true, .lobes = true, .tabulated = true, .states = true}};
  constexpr SurfaceClass kPlain{};
  std::vector<SurfaceClass> classes{{.sky = true}};
  for (DrawItem& item : tables.draws) {
    if (item.kind != DrawKind::Solid && item.kind != DrawKind::Ground) continue;
    const SurfaceClass own = classOf(item, sim, tables.solid);
    auto at = std::find_if(classes.begin() + 1, classes.end(), [&](const SurfaceClass& c) { return (c == kPlain) == (own == kPlain); });
    if (at == classes.end()) at = classes.insert(classes.end(), own);
    else *at = both(*at, own);
    item.surfaceClass = static_cast<int>(at - classes.begin());
  }
  return classes;
}

void addClassSlots(const SurfaceClass& own, const RenderTables& tables, ShaderSlots& slots) {
  const std::string folder = "sim/render/glsl/";
  slots.constants["SURFACES"] = own.sky ? 0 : 1;
  if (own.sky) {
    // The background's row is its radiance.
    slots.files["surface"] = folder + (tables.solid.general || !tables.solid.lit ? "surface_unlit.glsl" : "surface_simple.glsl");
    slots.files["lights"] = folder + "lights_none.glsl";
  }
  if (!own.lobes) {
    slots.constants["LOBES"] = 0;
    if (tables.solid.lit) slots.generated["lobes"] = "Real lobeOf(int kind, Vec4 parameters, Vec3 toLight) { return 1.0; }\n";
  }
  if (!own.states) slots.constants["STATES"] = 0;
  if (!own.tabulated && tables.solid.lit) slots.files["columns"] = folder + "columns_plain.glsl";
  if (!own.modifiers) slots.files["modifiers"] = folder + "modifiers_none.glsl";
  if (!own.temperatureTextures) slots.files["temperature"] = folder + "temperature_uniform.glsl";
}

}  // namespace pitviper
