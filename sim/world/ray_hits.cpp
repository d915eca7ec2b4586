#include "sim/world/ray_hits.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/field_drift.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/scene/triangle_tree.hpp"
#include "sim/world/field_states.hpp"

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

Hit hitAt(const Entity& entity, std::pair<int, int> place, std::uint32_t triangle, const TriangleMeeting& m, const BodyRay& ray, const glm::dvec3& origin,
          const glm::dvec3& direction) {
  const Mesh& mesh = *entity.mesh;
  const glm::uvec3 i = mesh.triangles[triangle];
  const glm::dvec3 w = m.weight;
  Hit hit;
  hit.entity = place.first;
  hit.surface = place.second;
  hit.distance = m.along;
  hit.point = origin + m.along * direction;
  hit.front = m.entering;
  const glm::dvec3 n = w.x * glm::dvec3(mesh.normals[i.x]) + w.y * glm::dvec3(mesh.normals[i.y]) + w.z * glm::dvec3(mesh.normals[i.z]);
  hit.normal = ray.localFromBody * glm::normalize(m.entering ? n : -n);
  const glm::dvec3 a(mesh.positions[i.x]);
  hit.facet = ray.localFromBody * glm::normalize(glm::cross(glm::dvec3(mesh.positions[i.y]) - a, glm::dvec3(mesh.positions[i.z]) - a));
  hit.triangle = triangle;
  hit.uv = w.x * glm::dvec2(mesh.uv[i.x]) + w.y * glm::dvec2(mesh.uv[i.y]) + w.z * glm::dvec2(mesh.uv[i.z]);
  return hit;
}

}  // namespace

size_t surfaceOf(const Entity& entity, std::uint32_t triangle) {
  for (size_t s = 0; s + 1 < entity.surfaces.size(); ++s) {
    const MeshPart& part = entity.mesh->parts[entity.surfaces[s].meshPart];
    if (triangle >= part.firstTriangle && triangle - part.firstTriangle < part.triangleCount) return s;
  }
  return entity.surfaces.size() - 1;
}

RayHits castRay(const Simulation& sim, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double nearest,
                const std::vector<char>* drawn, bool transparentOnly, int fieldSteps) {
  RayHits hits;
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    const Entity& entity = sim.entities[e];
    if ((drawn && !(*drawn)[e]) || !state.isThere(e) || (transparentOnly && !sim.isTransparent(entity))) continue;
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
      if (transparentOnly && !layer) return false;
      if (!layer && m.along == hits.solid.distance && place >= std::pair(hits.solid.entity, hits.solid.surface)) return false;
      const Hit hit = hitAt(entity, place, t, m, ray, origin, direction);
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
  hits.slabs = slabsAlong(sim, state, origin, direction, hits.solid.distance, fieldSteps);
  return hits;
}

std::vector<Slab> slabsAlong(const Simulation& sim, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double range_m,
                             int fieldSteps) {
  std::vector<Slab> slabs;
  std::vector<FieldStep> steps;
  for (size_t f = 0; fieldSteps > 0 && f < sim.fields.size(); ++f) {
    const FieldState* field = fieldOf(state, f);
    if (!field) continue;
    steps.clear();
    field->along({origin, direction, 0.0, std::min(range_m, physics::kFar)}, fieldSteps, steps);
    if (fieldSteps > kPlannedFieldSteps) setDrifts(steps);  // a plan's products have none
    for (const FieldStep& s : steps)
      if (s.leave_m > s.enter_m) slabs.push_back({static_cast<int>(f), s});
  }
  return slabs;
}

Footprint footprintOf(const Simulation& sim, const WorldState& state, const Hit& hit, const glm::dvec3& ray, const glm::dvec3& across, const glm::dvec3& up) {
  const Mesh& mesh = *sim.entities[static_cast<size_t>(hit.entity)].mesh;
  const glm::dmat3 bodyFromLocal = glm::transpose(glm::mat3_cast(state.entities[static_cast<size_t>(hit.entity)].orientation));
  const glm::uvec3 i = mesh.triangles[hit.triangle];
  const glm::dvec3 a(mesh.positions[i.x]), e1 = glm::dvec3(mesh.positions[i.y]) - a, e2 = glm::dvec3(mesh.positions[i.z]) - a;
  const glm::dvec2 uv1 = glm::dvec2(mesh.uv[i.y]) - glm::dvec2(mesh.uv[i.x]), uv2 = glm::dvec2(mesh.uv[i.z]) - glm::dvec2(mesh.uv[i.x]);
  const double lengths = hit.distance / glm::length(ray);
  const auto moved = [&](const glm::dvec3& step) {
    return physics::uvStep(bodyFromLocal * step, bodyFromLocal * ray, lengths, glm::cross(e1, e2), e1, e2, uv1, uv2);
  };
  return {moved(across), moved(up)};
}

bool meetsBody(const Simulation& sim, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double nearest, int index) {
  if (!state.isThere(static_cast<size_t>(index))) return false;
  const Entity& entity = sim.entities[static_cast<size_t>(index)];
  const Pose& pose = state.entities[static_cast<size_t>(index)];
  const glm::dvec3 to = pose.position + pose.orientation * glm::dvec3(entity.boundingCentre) - origin;
  const double radius = (1.0 + 1e-5) * static_cast<double>(entity.boundingRadius_m);  // it is single precision
  if (glm::length(to - glm::dot(to, direction) * direction) > radius) return false;
  const glm::dmat3 localFromBody = glm::mat3_cast(pose.orientation), bodyFromLocal = glm::transpose(localFromBody);
  const BodyRay ray{localFromBody, bodyFromLocal * (origin - pose.position), bodyFromLocal * direction};
  if (sim.mediumOf(entity)) {
    RayHits hits;
    addStretches(hits, entity, index, ray);
    return std::any_of(hits.stretches.begin(), hits.stretches.end(), [](const Stretch& s) { return s.leave > 0.0; });
  }
  bool met = false;
  treeOf(entity.mesh)->along(ray.origin, ray.direction, nearest, INFINITY, [&](std::uint32_t t) {
    const TriangleMeeting m = meetTriangle(*entity.mesh, t, ray.origin, ray.direction);
    return met = m.met && m.along >= nearest;
  });
  return met;
}

// The visibility pass may give a pixel's middle to a triangle whose edge runs beside it: the weights are held within it, as the shader's are.
Hit hitOf(const Simulation& sim, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, int entity, std::uint32_t triangle) {
  const Entity& body = sim.entities[static_cast<size_t>(entity)];
  const Pose& pose = state.entities[static_cast<size_t>(entity)];
  const glm::dmat3 localFromBody = glm::mat3_cast(pose.orientation), bodyFromLocal = glm::transpose(localFromBody);
  const BodyRay ray{localFromBody, bodyFromLocal * (origin - pose.position), bodyFromLocal * direction};
  const Mesh& mesh = *body.mesh;
  const glm::uvec3 i = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[i.x]), e1 = glm::dvec3(mesh.positions[i.y]) - a, e2 = glm::dvec3(mesh.positions[i.z]) - a;
  const glm::dvec3 p = glm::cross(ray.direction, e2), q = ray.origin - a, r = glm::cross(q, e1);
  const double det = glm::dot(e1, p), inverse = det != 0.0 ? 1.0 / det : 0.0;
  const double v = std::clamp(glm::dot(q, p) * inverse, 0.0, 1.0), w = std::clamp(glm::dot(ray.direction, r) * inverse, 0.0, 1.0 - v);
  TriangleMeeting m;
  m.met = true;
  // Of a triangle on edge no farther than its corners: a rasteriser sees it up to 1/256 of a pixel beside.
  const double near = -glm::dot(q, ray.direction), first = glm::dot(e1, ray.direction), second = glm::dot(e2, ray.direction);
  m.along = std::clamp(glm::dot(e2, r) * inverse, near + std::min({0.0, first, second}), near + std::max({0.0, first, second}));
  m.weight = {1.0 - v - w, v, w};
  m.entering = glm::dot(glm::cross(e1, e2), ray.direction) < 0.0;
  return hitAt(body, {entity, static_cast<int>(surfaceOf(body, triangle))}, triangle, m, ray, origin, direction);
}

}  // namespace pitviper
