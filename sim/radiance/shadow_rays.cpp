#include "sim/radiance/shadow_rays.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// A hit's point has the rounding of its range and of its place in the local frame, 1e-16 of either, over the cosine at which the ray met the
/// facet: a million times that still is 0.01 mm at 100 km.
constexpr double kRounding = 1e-10;

}  // namespace

ShadowCaster::ShadowCaster(const Simulation& sim) : simulation_(sim) {
  for (const Entity& e : sim.entities) {
    auto opaque = [&](const Surface& s) { return !sim.materialOf(s).isTransparent(); };
    bodies_.push_back(
        {std::any_of(e.surfaces.begin(), e.surfaces.end(), opaque), selfShadow(e, std::all_of(e.surfaces.begin(), e.surfaces.end(), opaque)), treeOf(e.mesh)});
  }
}

bool ShadowCaster::lit(const WorldState& state, const Hit& from, const glm::dvec3& toLight, double distance_m) const {
  const double outside = from.front ? 1.0 : -1.0, lightSide = glm::dot(from.facet, toLight) < 0.0 ? -1.0 : 1.0;
  for (size_t e = 0; e < bodies_.size(); ++e) {
    const Body& body = bodies_[e];
    const bool self = static_cast<int>(e) == from.entity;
    if (!body.casts || !state.isThere(e) || (self && (body.self == SelfShadow::Never || (body.self == SelfShadow::Inside && from.front)))) continue;
    const bool oneSided = self && (body.self != SelfShadow::Open || lightSide != outside);
    // Off the facet to the light's side: neither it nor what lies in its plane stands in the way.
    glm::dvec3 origin = from.point + kRounding * (glm::length(from.point) + from.distance) * lightSide * from.facet;
    const Pose& pose = state.entities[e];
    const glm::dmat3 bodyFromLocal = glm::transpose(glm::mat3_cast(pose.orientation));
    origin = bodyFromLocal * (origin - pose.position);
    const glm::dvec3 direction = bodyFromLocal * toLight;
    const Entity& entity = simulation_.entities[e];
    bool blocked = false;
    body.tree->along(origin, direction, 0.0, distance_m, [&](std::uint32_t t) {
      const TriangleMeeting m = meetTriangle(*entity.mesh, t, origin, direction);
      blocked = m.met && m.along > 0.0 && m.along < distance_m && !(oneSided && m.entering != from.front) &&
                !simulation_.materialOf(entity.surfaces[surfaceOf(entity, t)]).isTransparent();
      return blocked;
    });
    if (blocked) return false;
  }
  return true;
}

}  // namespace pitviper
