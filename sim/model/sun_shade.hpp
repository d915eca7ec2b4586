#pragma once
// What clouds of drops take of the sun on its way to a place.
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace pitviper {

/// Optical depth at 0.55 um from places to the sun, on a grid whose third axis is height and whose others lie across the sun's direction; below it that of its
/// lowest nodes, above it and beside it none.
struct SunShadeGrid {
  glm::ivec3 nodes{0};
  glm::dvec3 origin{0.0};                    ///< of the axes, local frame
  std::array<glm::dvec3, 3> axis{};          ///< nodes per metre: place of p is dot(axis, p - origin)
  std::vector<float> depth;                  ///< x fastest
  double at(const glm::dvec3& point) const;  ///< linear between nodes
};

class SunShade {
 public:
  virtual ~SunShade() = default;
  /// Made when first asked for. Safe to ask from several threads.
  virtual const SunShadeGrid& grid() const = 0;
  /// Index into Simulation::materials: the drops, whose absorption is what a unit of depth takes of the sun.
  int material = 0;
};

}  // namespace pitviper
