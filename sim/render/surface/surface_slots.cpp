#include "sim/render/surface/surface_slots.hpp"

#include <algorithm>

#include "sim/render/assembly/node_loops.hpp"

namespace pitviper {
namespace {

/// The bodies of all lobes, and the choice between them by number from 1 on.
std::string lobesText(const std::set<std::pair<std::string, std::string>>& lobes) {
  std::string uses, choice;
  int number = 0;
  for (const auto& [name, function] : lobes) {
    uses += "//@use " + name + "\n";
    choice += "  if (kind == " + std::to_string(++number) + ") return " + function + "(parameters, normal_, toLight, toViewer_);\n";
  }
  return uses + "Real lobeOf(int kind, Vec4 parameters, Vec3 toLight) {\n" + choice + "  return 1.0;\n}\n";
}

}  // namespace

void addSurfaceSlots(const SurfaceTables& tables, const SurfaceTerms& terms, const Plan& plan, ShaderSlots& slots) {
  auto file = [&](const char* slot, const char* name) { slots.files[slot] = surfaceShader(name); };
  slots.generated["lobes"] = tables.lit ? lobesText(terms.lobes) : "";
  slots.constants["STATES"] = tables.states ? 1 : 0;
  slots.constants["LOBES"] = tables.lit ? static_cast<long long>(terms.lobes.size()) : 0;
  slots.constants["COMPONENT_VECTORS"] = tables.vectors;
  slots.constants["COLUMN_TABLES"] = tables.second ? 2 : 1;
  slots.constants["COMPONENTS"] = slots.constants["USED_COMPONENTS"] = 3 * tables.vectors;
  slots.constants["EMISSION_MODIFIERS"] = slots.constants["TRANSMISSION_MODIFIERS"] = slots.constants["VIEW_ANGLES"] = 1;
  file("lights", !tables.lit || plan.lightCount == 0 ? "lights_none" : plan.lightCount <= kFewLights ? "lights_few" : "lights_many");
  setLightLoops(slots);
  file("columns", !tables.lit ? "columns_none" : tables.tabulated ? "columns_tabulated" : "columns_plain");
  file("temperature", !terms.temperatureTextures ? "temperature_uniform" : tables.planckAt >= 0 ? "temperature_tabulated" : "temperature_textured");
  file("footprint", plan.textureAccuracy > 0.0 ? "footprint_pixel" : "footprint_none");
  slots.constants["FILTERED"] = plan.textureAccuracy > 0.0 ? 1 : 0;
  const TextureTaps taps = tapsFor(plan.textureAccuracy);
  slots.constants["TAPS_PER_TEN_TEXELS"] = taps.perTenTexels;
  slots.constants["TAPS_ACROSS"] = taps.mostAcross;
  slots.constants["TAPS_ALONG"] = taps.mostAlong;
  file("modifiers", terms.modifiers ? "modifiers_textured" : "modifiers_none");
  // In full it is not told on the GPU at all: what is drawn there is truth.
  file("ambient", !plan.terms.ambient || plan.terms.surroundings == Terms::kWhole ? "ambient_none"
                  : plan.terms.surroundings > 0                                   ? "ambient_around"
                                                                                  : "ambient_dome");
  if (plan.terms.surroundings > 0) {
    const auto any = std::any_of(tables.materials.begin(), tables.materials.end(), [](const GpuMaterial& m) { return m.response[2] > 1; });
    std::uint32_t groups = 1;
    for (const GpuMaterial& m : tables.materials) groups = std::max(groups, m.response[1]);
    slots.constants["AROUND_GROUPS"] = groups;
    slots.constants["AROUND_DEGREE"] = plan.terms.surroundings;
    slots.constants["AROUND_PLAIN"] = any ? 0 : 1;
  }
  if (tables.planckAt < 0) return;
  slots.constants["PLANCK_AT"] = tables.planckAt;
  slots.constants["PLANCK_ENTRIES"] = kPlanckEntries;
}

}  // namespace pitviper
