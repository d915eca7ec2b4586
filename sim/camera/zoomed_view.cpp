#include "sim/camera/zoomed_view.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {

Ball ballOf(const Simulation& sim, const WorldState& state, int entity) {
  const auto e = static_cast<size_t>(entity);
  return {entity, -1, state.entities[e].position + state.entities[e].orientation * glm::dvec3(sim.entities[e].boundingCentre),
          static_cast<double>(sim.entities[e].boundingRadius_m)};
}

Ball around(const Ball& a, const Ball& b) {
  const glm::dvec3 between = b.centre - a.centre;
  const double apart = glm::length(between);
  if (apart + b.radius_m <= a.radius_m) return a;
  if (apart + a.radius_m <= b.radius_m) return {a.entity, a.surface, b.centre, b.radius_m};
  const double radius = 0.5 * (apart + a.radius_m + b.radius_m);
  return {a.entity, a.surface, a.centre + between * ((radius - a.radius_m) / apart), radius};
}

double extentOf(const Ball& b, const View& v) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (b.centre - v.position);
  const double depth = -p.z;
  if (depth <= 4.0 * b.radius_m + v.near_m || b.radius_m <= 0.0) return INFINITY;
  return 2.0 * b.radius_m / depth / std::min(v.tanPerPixelX, v.tanPerPixelY);
}

/// Rolled so that silhouettes are sampled evenly (an edge along the grid would be off by up to a whole row), nor does its middle lie on a place of the grid
/// that one shares with it: what is round would be off all around alike.
View zoomedView(const Ball& ball, const View& v, int size) {
  constexpr double kRoll_rad = 0.3926, kAcross = 0.31, kUp = 0.17;
  const glm::dvec3 line = ball.centre - v.position;
  const double distance = glm::length(line), radius = ball.radius_m;
  View z = v;
  z.subpixels = z.grouped = 1;
  z.kept = glm::ivec4(0);
  z.wanted = nullptr;
  z.width = z.height = size;
  z.localFromCamera = localFromCamera({v.position, orientationAlong(line, kRoll_rad)});
  z.tanPerPixelX = z.tanPerPixelY = 2.04 * radius / std::sqrt(distance * distance - radius * radius) / (size - 2.0 * kAcross);
  z.axisX = 0.5 * size + kAcross;
  z.axisY = 0.5 * size + kUp;
  z.onlyEntity = ball.entity;
  z.zoomed = true;
  z.depthCentre = ball.centre;
  z.depthRadius_m = 1.02 * radius;
  return z;
}

bool looksAt(const View& v, const glm::dvec3& direction) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * direction;
  if (p.z >= 0.0) return false;
  const glm::dvec2 at = filmPosition(v, p);
  return at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height;
}

bool mayOverlap(const Ball& a, const Ball& b, const glm::dvec3& from, double room) {
  const glm::dvec3 toA = a.centre - from, toB = b.centre - from;
  const double one = glm::length(toA), other = glm::length(toB);
  return glm::length(toA / one - toB / other) < room * (a.radius_m / one + b.radius_m / other);  // small angles
}

}  // namespace pitviper
