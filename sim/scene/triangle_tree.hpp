#pragma once
// A hierarchy of boxes over triangles of a mesh, in body coordinates: what a ray meets is found without testing every triangle. The same on
// every machine: it depends on nothing but the mesh.
#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/scene/mesh.hpp"

namespace pitviper {

class TriangleTree {
 public:
  /// Depth first: a ray that misses a box goes on at `skip`, else at the next node. Boxes are exact, as the vertices are floats.
  struct Node {
    glm::vec3 low{0.0f}, high{0.0f};
    std::uint32_t skip = 0;
    std::uint32_t first = 0, count = 0;  ///< of order(); count 0: an inner node
  };

  /// Over some triangles of a mesh (numbers of Mesh::triangles), or all. The mesh is not kept.
  TriangleTree(const Mesh& mesh, std::vector<std::uint32_t> triangles);
  explicit TriangleTree(const Mesh& mesh);

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Calls visit(triangle) for those whose box the line origin + t direction meets for t in [nearest, farthest], in the order of the
  /// tree; stops where it returns true. `farthest` may shrink on the way.
  template <class Visit>
  void along(const glm::dvec3& origin, const glm::dvec3& direction, double nearest, const double& farthest, Visit visit) const {
    for (std::uint32_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (!meets(node, origin, direction, nearest, farthest)) {
        n = node.skip;
        continue;
      }
      for (std::uint32_t k = 0; k < node.count; ++k)
        if (visit(order_[node.first + k])) return;
      ++n;
    }
  }

 private:
  static bool meets(const Node& node, const glm::dvec3& origin, const glm::dvec3& direction, double nearest, double farthest) {
    constexpr double kSlack = 1e-12;  // rounding of the two divisions, many times over: a grazed box is looked into
    for (int k = 0; k < 3; ++k) {
      const double low = static_cast<double>(node.low[k]) - origin[k], high = static_cast<double>(node.high[k]) - origin[k];
      if (direction[k] == 0.0) {
        if (low > 0.0 || high < 0.0) return false;
        continue;
      }
      const double a = low / direction[k], b = high / direction[k];
      nearest = std::max(nearest, std::min(a, b) - kSlack * std::abs(a));
      farthest = std::min(farthest, std::max(a, b) + kSlack * std::abs(b));
    }
    return nearest <= farthest;
  }
  void build(const Mesh& mesh, const std::vector<glm::vec3>& centre, std::uint32_t first, std::uint32_t count);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/// Where a line meets a triangle.
struct TriangleMeeting {
  double along = 0.0;      ///< in units of the direction
  glm::dvec3 weight{0.0};  ///< of its corners
  bool entering = false;   ///< against its outward normal
  bool met = false;
};

/// A line through an edge or a corner that neighbours share meets one of them: what counts crossings counts each sheet once.
/// Source: Moeller and Trumbore 1997; ties after Edelsbrunner and Muecke 1990.
TriangleMeeting meetTriangle(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& origin, const glm::dvec3& direction);

/// A mesh's tree over all triangles, made when first asked for and kept as long as the mesh lives.
std::shared_ptr<const TriangleTree> treeOf(const std::shared_ptr<const Mesh>& mesh);

/// What a mesh can hide of itself: a convex closed one nothing of its outside, a flat one nothing at all.
enum class Bulk { Flat, Convex, Other };
/// Found when first asked for. Vertices may stand out of a facet's plane by 1e-6 of the mesh's size, the rounding of single precision. Meshes
/// of more than 200,000 triangles are called Other unseen.
Bulk bulkOf(const std::shared_ptr<const Mesh>& mesh);

}  // namespace pitviper
