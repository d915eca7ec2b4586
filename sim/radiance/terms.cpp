#include "sim/radiance/terms.hpp"

#include "sim/world/shadow_casters.hpp"

namespace pitviper {
namespace {

void add(SurfaceTerms& t, const Material& m, const Surface& s) {
  t.any = true;
  t.reflects |= !m.reflections.empty();
  t.emits |= !m.given || m.given->tabulated() || !m.given->spectrum.isZero();
  t.angular |= m.needsAngles();
  t.modifiers |= m.hasModifiers();
  t.temperatureTextures |= s.temperatureTexture >= 0;
  for (const auto& r : m.reflections)
    if (const Lobe& lobe = r->lobe(); !lobe.file.empty()) t.lobes.emplace(lobe.file, lobe.function);
}

}  // namespace

Terms termsOf(const Simulation& sim) {
  Terms t;
  t.air = sim.air && sim.air->traits().any;
  t.scatteredSun = t.air && sim.air->traits().scattersSun && sim.sun.has_value();
  t.streams = t.air && sim.air->traits().scattersSun ? kUsualStreams : 0;
  t.lights = !sim.lights.empty() || sim.sun;
  t.ambient = sim.ambient && !sim.ambient->isZero();
  t.shadows = canHaveShadows(sim);
  t.fields = !sim.fields.empty();
  if (sim.ground) add(t.solid, sim.materialOf(*sim.ground), *sim.ground);
  for (const auto& e : sim.entities) {
    t.media |= sim.mediumOf(e) != nullptr;
    if (sim.mediumOf(e)) continue;
    for (const auto& s : e.surfaces) add(sim.materialOf(s).transmission ? t.layer : t.solid, sim.materialOf(s), s);
  }
  return withSurroundings(t, t.ambient && sim.surroundings ? Terms::kWhole : 0);
}

Terms withSurroundings(Terms t, int degree) {
  t.surroundings = degree;
  for (SurfaceTerms* s : {&t.solid, &t.layer}) s->surroundings = degree != 0 && s->reflects;
  return t;
}

}  // namespace pitviper
