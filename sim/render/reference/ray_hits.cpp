#include "sim/render/reference/ray_hits.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/scene/triangle_tree.hpp"

namespace pitviper {
namespace {

/// A body's pose against the ray.
struct BodyRay {
  glm::dmat3 localFromBody;
  glm::dvec3 origin, direction;
};

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
  const double endless = INFINITY;
  treeOf(entity.mesh)->along(ray.origin, ray.direction, -INFINITY, endless, [&](std::uint32_t t) {
    const TriangleMeeting m = meetTriangle(*entity.mesh, t, ray.origin, ray.direction);
    if (m.met) crossings.emplace_back(m.along, m.entering ? 1 : -1);
    return false;
  });
  std::sort(crossings.begin(), crossings.end());
  int inside = 0;
  for (size_t k = 0; k < crossings.size(); ++k) {
    inside += crossings[k].second;
    if (inside > 0 && k + 1 < crossings.size())
      for (int n = 0; n < inside; ++n) hits.stretches.push_back({index, crossings[k].first, crossings[k + 1].first});
  }
}

}  // namespace

size_t surfaceOf(const Entity& entity, std::uint32_t triangle) {
  for (size_t s = 0; s + 1 < entity.surfaces.size(); ++s) {
    const MeshPart& part = entity.mesh->parts[entity.surfaces[s].meshPart];
    if (triangle >= part.firstTriangle && triangle - part.firstTriangle < part.triangleCount) return s;
  }
  return entity.surfaces.size() - 1;
}

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
    treeOf(entity.mesh)->along(ray.origin, ray.direction, nearest, hits.solid.distance, [&](std::uint32_t t) {
      const TriangleMeeting m = meetTriangle(mesh, t, ray.origin, ray.direction);
      if (!m.met || m.along < nearest || m.along > hits.solid.distance) return false;
      const size_t s = surfaceOf(entity, t);
      const bool layer = sim.materialOf(entity.surfaces[s]).transmission.has_value();
      // Of two in one place the first of the scenario is seen, whatever the order of the tree.
      const std::pair place(static_cast<int>(e), static_cast<int>(s));
      if (!layer && m.along == hits.solid.distance && place >= std::pair(hits.solid.entity, hits.solid.surface)) return false;
      const glm::uvec3 i = mesh.triangles[t];
      const glm::dvec3 w = m.weight;
      Hit hit;
      hit.entity = place.first;
      hit.surface = place.second;
      hit.distance = m.along;
      hit.point = origin + m.along * direction;
      hit.front = m.entering;
      const glm::dvec3 n = w.x * glm::dvec3(mesh.normals[i.x]) + w.y * glm::dvec3(mesh.normals[i.y]) + w.z * glm::dvec3(mesh.normals[i.z]);
      hit.normal = localFromBody * glm::normalize(m.entering ? n : -n);
      const glm::dvec3 a(mesh.positions[i.x]);
      hit.facet = localFromBody * glm::normalize(glm::cross(glm::dvec3(mesh.positions[i.y]) - a, glm::dvec3(mesh.positions[i.z]) - a));
      hit.uv = w.x * glm::dvec2(mesh.uv[i.x]) + w.y * glm::dvec2(mesh.uv[i.y]) + w.z * glm::dvec2(mesh.uv[i.z]);
      if (layer) hits.layers.push_back(hit);
      else hits.solid = hit;
      return false;
    });
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
