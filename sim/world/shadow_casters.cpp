#include "sim/world/shadow_casters.hpp"

#include <map>

#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Frames beyond which a lone body is not followed to see whether a camera enters it.
constexpr int kMostFrames = 10000;

/// Numbers of an entity's opaque triangles.
std::vector<std::uint32_t> opaqueTriangles(const Simulation& sim, const Entity& entity) {
  std::vector<std::uint32_t> found;
  if (sim.mediumOf(entity)) return found;
  for (const Surface& s : entity.surfaces) {
    if (sim.materialOf(s).isTransparent()) continue;
    const MeshPart& part = entity.mesh->parts[s.meshPart];
    for (std::uint32_t t = 0; t < part.triangleCount; ++t) found.push_back(part.firstTriangle + t);
  }
  return found;
}

bool staysOutside(const Simulation& sim) {
  if (sim.time.frames > kMostFrames) return false;
  for (int frame = 0; frame < sim.time.frames; ++frame) {
    const WorldState state = advance(sim, sim.time.at(frame));
    const Pose& pose = state.entities[0];
    const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(sim.entities[0].boundingCentre);
    auto inside = [&](const glm::dvec3& p) { return glm::length(p - centre) <= static_cast<double>(sim.entities[0].boundingRadius_m); };
    for (const Camera& c : sim.cameras)
      if (inside(cameraAt(c, state).pose.position)) return false;
    for (const Probe& p : sim.probes)
      if (inside(p.position)) return false;
  }
  return true;
}

/// An ellipsoid's mesh has its corners on it; others are looked at, which takes long.
Bulk bulkOfEntity(const Entity& entity) { return entity.form.kind == BodyForm::Kind::Ellipsoid ? Bulk::Convex : bulkOf(entity.mesh); }

}  // namespace

SelfShadow selfShadow(const Entity& entity, bool whole) {
  const Bulk bulk = bulkOfEntity(entity);
  if (bulk == Bulk::Flat) return SelfShadow::Never;
  if (bulk == Bulk::Convex) return SelfShadow::Inside;
  return (entity.mesh->closed && whole) || entity.mesh->heightField ? SelfShadow::OneSided : SelfShadow::Open;
}

std::vector<ShadowCasterBody> shadowCasters(const Simulation& sim) {
  std::vector<ShadowCasterBody> bodies;
  std::map<std::pair<const Mesh*, std::vector<std::uint32_t>>, std::shared_ptr<const TriangleTree>> parts;
  for (const Entity& entity : sim.entities) {
    ShadowCasterBody& body = bodies.emplace_back();
    const Mesh& mesh = *entity.mesh;
    auto triangles = opaqueTriangles(sim, entity);
    if (triangles.empty()) continue;
    const bool whole = triangles.size() == mesh.triangles.size();
    body.self = selfShadow(entity, whole);
    if (whole) {
      body.tree = treeOf(entity.mesh);
      continue;
    }
    auto& tree = parts[{&mesh, triangles}];
    if (!tree) tree = std::make_shared<const TriangleTree>(mesh, triangles);
    body.tree = tree;
  }
  return bodies;
}

bool canHaveShadows(const Simulation& sim) {
  if (!sim.shadows || (sim.lights.empty() && !sim.sun)) return false;
  bool casts = false, reflects = false;
  for (const Entity& e : sim.entities)
    for (const Surface& s : e.surfaces) {
      const Material& m = sim.materialOf(s);
      casts |= !m.isTransparent();
      reflects |= !m.reflections.empty();
    }
  if (!casts || !reflects) return false;
  if (sim.entities.size() > 1) return true;
  const Bulk bulk = bulkOfEntity(sim.entities[0]);
  return !(bulk == Bulk::Flat || (bulk == Bulk::Convex && staysOutside(sim)));
}

}  // namespace pitviper
