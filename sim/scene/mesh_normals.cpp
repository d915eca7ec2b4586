#include "sim/scene/mesh_normals.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "sim/scene/bit_key.hpp"
#include "sim/scene/mesh_edges.hpp"

namespace pitviper {
namespace {

/// A vertex of the changed mesh: what becomes of its normal, then the vertex that it was; or its smoothing group and the bits of its uv.
using Key = std::array<std::uint32_t, 4>;

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : otherwise;
}

/// Corners (3 t + k) of triangles that meet at a place and are joined by edges bent less than the crease: one root
/// each.
std::vector<std::uint32_t> smoothingGroups(const Mesh& mesh, const std::vector<glm::dvec3>& faceNormals, double leastCosine) {
  std::vector<std::uint32_t> parent(mesh.triangles.size() * 3);
  std::iota(parent.begin(), parent.end(), 0u);
  const std::vector<MeshEdge> edges = sortedEdges(mesh, weldByPosition(mesh));
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const MeshEdge &a = edges[i], &b = edges[i + 1];
    if (a.places != b.places || a.forward == b.forward) continue;
    if (i > 0 && edges[i - 1].places == a.places) continue;  // more than two triangles: a crease
    if (i + 2 < edges.size() && edges[i + 2].places == a.places) continue;
    if (glm::dot(faceNormals[a.triangle], faceNormals[b.triangle]) < leastCosine) continue;
    const auto join = [&](std::uint32_t ka, std::uint32_t kb) { parent[rootOf(parent, a.triangle * 3 + ka % 3)] = rootOf(parent, b.triangle * 3 + kb % 3); };
    join(a.corner, b.corner + 1u);
    join(a.corner + 1u, b.corner);
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = rootOf(parent, i);
  return parent;
}

}  // namespace

void computeNormals(Mesh& mesh, double creaseAngle_rad) {
  changeNormals(mesh, std::vector<CornerNormal>(mesh.triangles.size() * 3, CornerNormal::Made), creaseAngle_rad);
}

void changeNormals(Mesh& mesh, const std::vector<CornerNormal>& wish, double creaseAngle_rad) {
  std::vector<glm::dvec3> faceNormals;
  faceNormals.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) faceNormals.push_back(unitOr(areaVector(mesh, t), {0.0, 0.0, 1.0}));
  const std::vector<std::uint32_t> group = smoothingGroups(mesh, faceNormals, std::cos(creaseAngle_rad));

  std::vector<glm::dvec3> sums(group.size(), glm::dvec3(0.0));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 at(mesh.positions[mesh.triangles[t][k]]);
      const glm::dvec3 u = glm::dvec3(mesh.positions[mesh.triangles[t][(k + 1) % 3]]) - at;
      const glm::dvec3 v = glm::dvec3(mesh.positions[mesh.triangles[t][(k + 2) % 3]]) - at;
      sums[group[3 * t + k]] += faceNormals[t] * std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
    }

  Mesh out;
  std::unordered_map<Key, std::uint32_t, BitKeyHash> known;
  known.reserve(mesh.positions.size());
  const bool hasUv = mesh.uv.size() == mesh.positions.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t i = mesh.triangles[t][k], root = group[3 * t + k];
      const glm::vec2 uv = hasUv ? mesh.uv[i] : glm::vec2(0.0f);
      const CornerNormal what = wish[3 * t + k];
      const bool made = what == CornerNormal::Made;
      const Key key{static_cast<std::uint32_t>(what), made ? root : i, made ? bitsOf(uv.x) : 0u, made ? bitsOf(uv.y) : 0u};
      const auto [entry, isNew] = known.try_emplace(key, static_cast<std::uint32_t>(out.positions.size()));
      if (isNew) {
        out.positions.push_back(mesh.positions[i]);
        out.normals.push_back(made ? glm::vec3(unitOr(sums[root], faceNormals[t])) : what == CornerNormal::Turned ? -mesh.normals[i] : mesh.normals[i]);
        out.uv.push_back(uv);
      }
      mesh.triangles[t][k] = entry->second;
    }
  mesh.positions = std::move(out.positions);
  mesh.normals = std::move(out.normals);
  mesh.uv = std::move(out.uv);
}

}  // namespace pitviper
