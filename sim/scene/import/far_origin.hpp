#pragma once
// Meshes far from their file's origin: what single precision can hold of them.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pitviper {

/// What to take off all vertices of a box before they become single precision: 0 where coordinates are at most four times as large as the mesh, so that
/// two bits are lost; else its middle, on a grid as wide as a sixteenth of the mesh or more, so that differences of doubles stay exact. 0 also for a box
/// without end.
inline glm::dvec3 farOrigin(const glm::dvec3& low, const glm::dvec3& high) {
  constexpr double kFar = 4.0;
  const glm::dvec3 size = high - low;
  const double extent = std::max({size.x, size.y, size.z});
  const double farthest = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y), std::abs(high.z)});
  if (!std::isfinite(extent) || !(extent > 0.0) || farthest <= kFar * extent) return glm::dvec3(0.0);
  const double step = std::exp2(std::floor(std::log2(extent)) - 3.0);
  return step * glm::round((0.5 * low + 0.5 * high) / step);
}

}  // namespace pitviper
