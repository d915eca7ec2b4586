#include "scenarios/session/same_bodies.hpp"

#include <algorithm>

#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {
namespace {

bool sameMesh(const Mesh& a, const Mesh& b) {
  return &a == &b || (a.positions == b.positions && a.normals == b.normals && a.uv == b.uv && a.triangles == b.triangles && a.closed == b.closed &&
                      a.offset_m == b.offset_m && a.parts.size() == b.parts.size());
}

/// What it is made of, as bytes; null is none.
template <class Part>
std::string bytesOfPart(const Part* part) {
  Fingerprint f;
  if (part) part->addTo(f);
  return f.bytes();
}

}  // namespace

bool sameBodies(const Simulation& a, const Simulation& b) {
  if (a.entities.size() != b.entities.size() || a.textures.size() != b.textures.size()) return false;
  for (std::size_t e = 0; e < a.entities.size(); ++e) {
    const Entity &x = a.entities[e], &y = b.entities[e];
    if (!sameMesh(*x.mesh, *y.mesh) || x.form.kind != y.form.kind || x.form.size != y.form.size || x.surfaces.size() != y.surfaces.size()) return false;
    for (std::size_t s = 0; s < x.surfaces.size(); ++s)
      if (x.surfaces[s].meshPart != y.surfaces[s].meshPart || a.materialOf(x.surfaces[s]).isTransparent() != b.materialOf(y.surfaces[s]).isTransparent())
        return false;
  }
  for (std::size_t t = 0; t < a.textures.size(); ++t)
    if (a.textures[t].texels != b.textures[t].texels || a.textures[t].width != b.textures[t].width) return false;
  return true;
}

bool sameAir(const Simulation& a, const Simulation& b) {
  const auto groundOf = [](const Simulation& s) {
    Fingerprint f;
    if (s.ground) addTo(f, s.materialOf(*s.ground)), f.add(s.ground->temperature_K);
    if (s.sun) f.add(s.sun->toSun), addTo(f, s.sun->irradiance);
    return f.bytes();
  };
  return bytesOfPart(a.air.get()) == bytesOfPart(b.air.get()) && bytesOfPart(a.surroundings.get()) == bytesOfPart(b.surroundings.get()) &&
         groundOf(a) == groundOf(b);
}

}  // namespace pitviper
