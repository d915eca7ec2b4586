#include "sim/render/geometry/mesh_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pitviper {
namespace {

/// Triangles in a cluster at most, and of a mesh that is worth cutting up.
constexpr std::uint32_t kCluster = 256, kWorthClusters = 4096;

glm::dvec3 cornerOf(const Mesh& mesh, std::uint32_t triangle, int k) { return glm::dvec3(mesh.positions[mesh.triangles[triangle][k]]); }

MeshCluster clusterOf(const Mesh& mesh, const std::vector<std::uint32_t>& order, std::uint32_t first, std::uint32_t count) {
  MeshCluster c{first, count};
  glm::dvec3 low(INFINITY), high(-INFINITY);
  std::vector<glm::dvec3> normals;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const glm::dvec3 p[3] = {cornerOf(mesh, order[i], 0), cornerOf(mesh, order[i], 1), cornerOf(mesh, order[i], 2)};
    for (const glm::dvec3& corner : p) low = glm::min(low, corner), high = glm::max(high, corner);
    const glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (const double length = glm::length(n); length > 0.0) normals.push_back(n / length), c.axis += normals.back();
  }
  c.centre = 0.5 * (low + high);
  c.radius_m = 0.5 * glm::length(high - low) * (1.0 + 1e-9);
  const double length = glm::length(c.axis);
  if (!(length > 0.0)) return c;
  c.axis /= length;
  double least = 1.0;
  for (const glm::dvec3& n : normals) least = std::min(least, glm::dot(n, c.axis));
  // Rounding of the normals.
  if (least > 1e-6) c.spread = std::sqrt(1.0 - least * least) + 1e-6;
  return c;
}

/// Halves by the longest axis of the triangles' middles until they are few.
void cut(const Mesh& mesh, std::uint32_t first, std::uint32_t count, ClusteredMesh& into) {
  if (count <= kCluster) {
    into.clusters.push_back(clusterOf(mesh, into.order, first, count));
    return;
  }
  const auto middleOf = [&](std::uint32_t t) { return cornerOf(mesh, t, 0) + cornerOf(mesh, t, 1) + cornerOf(mesh, t, 2); };
  glm::dvec3 low(INFINITY), high(-INFINITY);
  const auto begin = into.order.begin() + first, end = begin + count;
  for (auto t = begin; t != end; ++t) low = glm::min(low, middleOf(*t)), high = glm::max(high, middleOf(*t));
  const glm::dvec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, end, [&](std::uint32_t a, std::uint32_t b) {
    const double ma = middleOf(a)[axis], mb = middleOf(b)[axis];
    return ma != mb ? ma < mb : a < b;
  });
  cut(mesh, first, half, into);
  cut(mesh, first + half, count - half, into);
}

}  // namespace

bool MeshCluster::facesAway(const glm::dvec3& eye) const {
  // A triangle through p faces away where (p - eye) . n >= 0: for all normals of the cone where (p - eye) . axis >= sin(half angle) |p - eye|. That difference
  // falls from the centre on by no more than the way gone, so it holds all over the ball where it is the ball's radius at the centre. The margin is rounding.
  const glm::dvec3 line = centre - eye;
  return spread <= 1.0 && glm::dot(line, axis) >= spread * glm::length(line) + radius_m * (1.0 + 1e-6);
}

ClusteredMesh clustersOf(const Mesh& mesh) {
  ClusteredMesh all;
  all.order.resize(mesh.triangles.size());
  std::iota(all.order.begin(), all.order.end(), 0u);
  if (mesh.triangles.size() < kWorthClusters) return all;
  for (const MeshPart& part : mesh.parts)
    if (part.triangleCount > 0) cut(mesh, part.firstTriangle, part.triangleCount, all);
  return all;
}

}  // namespace pitviper
