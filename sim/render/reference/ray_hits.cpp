#include "sim/render/reference/ray_hits.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// A body's pose against the ray.
struct BodyRay {
  glm::dmat3 localFromBody;
  glm::dvec3 origin, direction;
};

/// Calls visit(distance, u, v, w, corners, frontFacing) for every triangle of a part that the ray meets.
template <class Visit>
void meetTriangles(const Mesh& mesh, const MeshPart& part, const BodyRay& ray, Visit visit) {
  for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t) {
    const glm::uvec3 i = mesh.triangles[t];
    const glm::dvec3 a(mesh.positions[i.x]), e1 = glm::dvec3(mesh.positions[i.y]) - a, e2 = glm::dvec3(mesh.positions[i.z]) - a;
    const glm::dvec3 p = glm::cross(ray.direction, e2);
    const double det = glm::dot(e1, p);
    if (det == 0.0) continue;
    const glm::dvec3 q = ray.origin - a;
    const double v = glm::dot(q, p) / det;
    const glm::dvec3 r = glm::cross(q, e1);
    const double w = glm::dot(ray.direction, r) / det;
    if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
    visit(glm::dot(e2, r) / det, glm::dvec3(1.0 - v - w, v, w), i, glm::dot(glm::cross(e1, e2), ray.direction) < 0.0);
  }
}

void addStretches(RayHits& hits, const Entity& entity, int index, const BodyRay& ray) {
  if (entity.form.kind != BodyForm::Kind::Mesh) {
    // From the foot of the body's origin on the ray, so that a far body's chord keeps its digits.
    const double foot = -glm::dot(ray.origin, ray.direction);
    const glm::dvec3 at = ray.origin + foot * ray.direction, &s = entity.form.size;
    const glm::dvec2 chord =
        entity.form.kind == BodyForm::Kind::Ellipsoid ? physics::ellipsoidChord(at, ray.direction, s) : physics::coneChord(at, ray.direction, s.x, s.y, s.z);
    if (chord.y > chord.x) hits.stretches.push_back({index, foot + chord.x, foot + chord.y});
    return;
  }
  std::vector<std::pair<double, int>> crossings;
  for (const MeshPart& part : entity.mesh->parts)
    meetTriangles(*entity.mesh, part, ray, [&](double t, const glm::dvec3&, const glm::uvec3&, bool front) { crossings.emplace_back(t, front ? 1 : -1); });
  std::sort(crossings.begin(), crossings.end());
  int inside = 0;
  for (size_t k = 0; k < crossings.size(); ++k) {
    inside += crossings[k].second;
    if (inside > 0 && k + 1 < crossings.size())
      for (int n = 0; n < inside; ++n) hits.stretches.push_back({index, crossings[k].first, crossings[k + 1].first});
  }
}

}  // namespace

RayHits castRay(const Simulation& sim, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double nearest) {
  RayHits hits;
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    const Entity& entity = sim.entities[e];
    const Pose& pose = state.entities[e];
    const glm::dmat3 localFromBody = glm::mat3_cast(pose.orientation), bodyFromLocal = glm::transpose(localFromBody);
    const BodyRay ray{localFromBody, bodyFromLocal * (origin - pose.position), bodyFromLocal * direction};
    if (sim.mediumOf(entity)) {
      addStretches(hits, entity, static_cast<int>(e), ray);
      continue;
    }
    const Mesh& mesh = *entity.mesh;
    for (size_t s = 0; s < entity.surfaces.size(); ++s) {
      const bool layer = sim.materialOf(entity.surfaces[s]).transmission.has_value();
      meetTriangles(mesh, mesh.parts[entity.surfaces[s].meshPart], ray, [&](double along, const glm::dvec3& weight, const glm::uvec3& i, bool front) {
        if (along < nearest || (!layer && along >= hits.solid.distance)) return;
        glm::dvec3 n = weight.x * glm::dvec3(mesh.normals[i.x]) + weight.y * glm::dvec3(mesh.normals[i.y]) + weight.z * glm::dvec3(mesh.normals[i.z]);
        if (!front) n = -n;
        const Hit hit = {static_cast<int>(e),
                         static_cast<int>(s),
                         along,
                         origin + along * direction,
                         localFromBody * glm::normalize(n),
                         weight.x * glm::dvec2(mesh.uv[i.x]) + weight.y * glm::dvec2(mesh.uv[i.y]) + weight.z * glm::dvec2(mesh.uv[i.z])};
        if (layer) hits.layers.push_back(hit);
        else hits.solid = hit;
      });
    }
  }
  std::erase_if(hits.layers, [&](const Hit& h) { return h.distance > hits.solid.distance; });
  for (Stretch& s : hits.stretches) {
    s.enter = std::max(s.enter, 0.0);
    s.leave = std::min(s.leave, hits.solid.distance);
  }
  std::erase_if(hits.stretches, [](const Stretch& s) { return s.leave <= s.enter; });
  return hits;
}

}  // namespace pitviper
