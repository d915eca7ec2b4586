#pragma once
// How the triangles of a mesh hang together: vertices at one place are one, and edges join places.
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// For each vertex the number of its position: vertices at exactly the same place share one.
std::vector<std::uint32_t> weldByPosition(const Mesh& mesh);

/// Twice the triangle's area times its normal.
glm::dvec3 areaVector(const Mesh& mesh, const glm::uvec3& triangle);

/// One of the three directed edges of a triangle, between welded places, smaller place first.
struct MeshEdge {
  std::uint64_t places;  ///< smaller place in the upper half
  std::uint32_t triangle;
  std::uint8_t corner;  ///< where the edge starts
  bool forward;         ///< runs from the smaller place to the larger
  bool hasLength() const { return places >> 32 != (places & 0xffffffffu); }
  friend bool operator<(const MeshEdge& a, const MeshEdge& b) { return a.places != b.places ? a.places < b.places : a.triangle < b.triangle; }
};

/// Those of one pair of places stand together.
std::vector<MeshEdge> sortedEdges(const Mesh& mesh, const std::vector<std::uint32_t>& place);

/// Of a forest of parents; shortens the way.
std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t i);

}  // namespace pitviper
