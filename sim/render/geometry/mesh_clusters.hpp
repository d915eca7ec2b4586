#pragma once
// Neighbouring triangles of a mesh together, so that those out of a view, or seen from behind, are left out by the hundred.
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// A run of triangles in the order that a mesh is drawn in; a ball about them and a cone about their normals (body axes) [m].
struct MeshCluster {
  std::uint32_t first = 0, count = 0;
  glm::dvec3 centre{0.0};
  double radius_m = 0.0;
  glm::dvec3 axis{0.0};  ///< unit
  double spread = 2.0;   ///< sine of the angle between the axis and the farthest normal; more than 1: they face all ways

  /// Whether an eye sees none of the triangles from outside.
  bool facesAway(const glm::dvec3& eye) const;
};

struct ClusteredMesh {
  std::vector<std::uint32_t> order;  ///< of triangles; each part keeps its place
  std::vector<MeshCluster> clusters;
};

/// Small meshes keep their order and have no clusters.
ClusteredMesh clustersOf(const Mesh& mesh);

}  // namespace pitviper
