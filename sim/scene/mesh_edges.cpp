#include "sim/scene/mesh_edges.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "sim/scene/bit_key.hpp"

namespace pitviper {
namespace {

using Key = std::array<std::uint32_t, 3>;

}  // namespace

std::vector<std::uint32_t> weldByPosition(const Mesh& mesh) {
  std::vector<std::uint32_t> place(mesh.positions.size());
  std::unordered_map<Key, std::uint32_t, BitKeyHash> known;
  known.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    const Key key{bitsOf(p.x), bitsOf(p.y), bitsOf(p.z)};
    place[i] = known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second;
  }
  return place;
}

glm::dvec3 areaVector(const Mesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  return glm::cross(b - a, c - a);
}

std::vector<MeshEdge> sortedEdges(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<MeshEdge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint64_t a = place[mesh.triangles[t][k]], b = place[mesh.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, k, a < b});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace pitviper
