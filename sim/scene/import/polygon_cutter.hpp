#pragma once
// Polygons of a mesh into triangles.
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pitviper {

/// Cuts polygons, nearly flat and of any shape whose border doesn't cross itself: corners may be written twice, lie on one line or on another edge, and holes
/// may be joined to the border by bridges. The triangles' corners are the polygon's; each goes round as the polygon does, so that their areas add up to its
/// own. Ears are cut off, the best-shaped first. Keeps its memory from one polygon to the next.
class PolygonCutter {
 public:
  enum class Result {
    Cut,
    Flat,     ///< no area: no triangles
    Crossing  ///< its border crosses itself
  };
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  /// `triangles`: as numbers of corners. `noise`: what coordinates may be off by: a corner as near as that to an edge lies on it, unless the polygon is
  /// smaller.
  Result cut(std::span<const glm::dvec3> corners, double noise, Triangles& triangles);

 private:
  using Corner = std::uint32_t;

  bool covers(std::span<const glm::dvec3> corners, const Triangles& triangles) const;
  std::span<const glm::dvec3> mergedWithin(std::span<const glm::dvec3> corners, double noise);
  Result cutWithin(std::span<const glm::dvec3> corners, double noise, Triangles& triangles);
  void flatten(std::span<const glm::dvec3> corners, const glm::dvec3& normal);
  int turn(Corner a, Corner b, Corner c) const;
  bool samePlace(Corner a, Corner b) const { return flat_[a] == flat_[b]; }
  bool isConvex() const;
  bool crosses() const;
  bool mayCut(std::size_t at, bool strictly) const;
  double shapeOf(std::size_t at) const;
  void dropSpikes();
  bool cutBest(bool strictly, Triangles& triangles);
  double doubleArea() const;
  Corner corner(std::size_t at) const { return ring_[at % ring_.size()]; }

  std::vector<glm::dvec3> merged_;
  std::vector<glm::dvec2> flat_;  ///< corners, projected so that the polygon goes counter-clockwise
  std::vector<Corner> ring_;      ///< corners that are left, in order
  std::vector<char> tried_;
  std::vector<double> shape_;  ///< of their ears
  int u_ = 0, v_ = 1;          ///< axes of the plane
  double noise_ = 0.0;
};

}  // namespace pitviper
