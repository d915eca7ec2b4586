#include "sim/scene/triangle_tree.hpp"

#include <array>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <tuple>

namespace pitviper {
namespace {

constexpr std::uint32_t kLeaf = 4;  ///< triangles at most, unless they share one centre
constexpr int kBins = 16;

struct Box {
  glm::vec3 low{INFINITY}, high{-INFINITY};
  void add(const glm::vec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  void add(const Box& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
  double area() const {
    const glm::dvec3 e = glm::dvec3(high) - glm::dvec3(low);
    return e.x < 0.0 ? 0.0 : e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

Box boxOf(const Mesh& mesh, std::uint32_t t) {
  Box box;
  for (int k = 0; k < 3; ++k) box.add(mesh.positions[mesh.triangles[t][k]]);
  return box;
}

std::vector<std::uint32_t> allOf(const Mesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace

TriangleTree::TriangleTree(const Mesh& mesh) : TriangleTree(mesh, allOf(mesh)) {}

TriangleTree::TriangleTree(const Mesh& mesh, std::vector<std::uint32_t> triangles) : order_(std::move(triangles)) {
  std::vector<glm::vec3> centre(mesh.triangles.size());
  for (std::uint32_t t : order_) {
    const Box box = boxOf(mesh, t);
    centre[t] = 0.5f * (box.low + box.high);
  }
  nodes_.reserve(order_.size());
  if (!order_.empty()) build(mesh, centre, 0, static_cast<std::uint32_t>(order_.size()));
}

// Splits where the sum of area x triangles of the two halves is smallest. Source: Wald 2007, "On fast construction of SAH-based bounding
// volume hierarchies", 16 bins along the longest axis of the centres.
void TriangleTree::build(const Mesh& mesh, const std::vector<glm::vec3>& centre, std::uint32_t first, std::uint32_t count) {
  Box box, centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.add(boxOf(mesh, order_[i]));
    centres.add(centre[order_[i]]);
  }
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({box.low, box.high, 0, first, 0});
  const glm::vec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  if (count <= kLeaf) {
    nodes_[at].count = count;
    nodes_[at].skip = at + 1;
    return;
  }
  std::uint32_t half = count / 2;
  if (extent[axis] > 0.0f) {
    auto binOf = [&](std::uint32_t t) {
      return std::clamp(static_cast<int>(static_cast<float>(kBins) * ((centre[t][axis] - centres.low[axis]) / extent[axis])), 0, kBins - 1);
    };
    std::array<Box, kBins> bins;
    std::array<std::uint32_t, kBins> held{};
    for (std::uint32_t i = first; i < first + count; ++i) {
      const auto b = static_cast<size_t>(binOf(order_[i]));
      bins[b].add(boxOf(mesh, order_[i]));
      ++held[b];
    }
    std::array<double, kBins> above{};
    Box right;
    std::uint32_t number = 0;
    for (size_t b = kBins - 1; b > 0; --b) {
      right.add(bins[b]);
      number += held[b];
      above[b] = right.area() * number;
    }
    Box left;
    number = 0;
    double best = INFINITY;
    int split = 0;
    for (size_t b = 0; b + 1 < kBins; ++b) {
      left.add(bins[b]);
      number += held[b];
      const double cost = left.area() * number + above[b + 1];
      if (number > 0 && number < count && cost < best) {
        best = cost;
        split = static_cast<int>(b);
      }
    }
    const auto middle = std::stable_partition(order_.begin() + first, order_.begin() + first + count, [&](std::uint32_t t) { return binOf(t) <= split; });
    const auto some = static_cast<std::uint32_t>(middle - (order_.begin() + first));
    if (some > 0 && some < count) half = some;
  }
  build(mesh, centre, first, half);
  build(mesh, centre, first + half, count - half);
  nodes_[at].skip = static_cast<std::uint32_t>(nodes_.size());
}

namespace {

/// On which side a line passes an edge: > 0 or < 0, the very opposite for the same edge the other way round, so that of two neighbours one is
/// met and one is not. A line through the edge itself, to rounding, counts as if it ran a little aside: along x, where that says nothing y,
/// then z. So it does for all edges of a corner, and one of its triangles is met.
double sideOf(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& origin, const glm::dvec3& direction) {
  if (std::tie(to.x, to.y, to.z) < std::tie(from.x, from.y, from.z)) return -sideOf(to, from, origin, direction);
  // Twenty times the half unit of last place by which a product may be off.
  constexpr double kRounding = 2e-15;
  const glm::dvec3 edge = to - from, there = from - origin;
  const double side = glm::dot(direction, glm::cross(edge, there));
  if (side * side > kRounding * kRounding * glm::dot(direction, direction) * glm::dot(edge, edge) * glm::dot(there, there)) return side;
  const glm::dvec3 aside = glm::cross(direction, edge);
  return aside.x != 0.0 ? aside.x : aside.y != 0.0 ? aside.y : aside.z;
}

}  // namespace

TriangleMeeting meetTriangle(const Mesh& mesh, std::uint32_t triangle, const glm::dvec3& origin, const glm::dvec3& direction) {
  const glm::uvec3& i = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[i.x]), b(mesh.positions[i.y]), c(mesh.positions[i.z]), e1 = b - a, e2 = c - a;
  const glm::dvec3 p = glm::cross(direction, e2);
  const double det = glm::dot(e1, p);
  if (det == 0.0) return {};
  const double ab = sideOf(a, b, origin, direction), bc = sideOf(b, c, origin, direction), ca = sideOf(c, a, origin, direction);
  if (!(ab > 0.0 && bc > 0.0 && ca > 0.0) && !(ab < 0.0 && bc < 0.0 && ca < 0.0)) return {};
  const glm::dvec3 q = origin - a, r = glm::cross(q, e1);
  const double v = glm::dot(q, p) / det, w = glm::dot(direction, r) / det;
  return {glm::dot(e2, r) / det, {1.0 - v - w, v, w}, det > 0.0, true};
}

namespace {

struct Known {
  std::weak_ptr<const Mesh> mesh;
  std::shared_ptr<const TriangleTree> tree;
  std::optional<Bulk> bulk;
};

std::mutex& knownMutex() {
  static std::mutex mutex;
  return mutex;
}

/// The mutex is held.
Known& known(const std::shared_ptr<const Mesh>& mesh) {
  static std::map<const Mesh*, Known> all;
  // A new mesh may stand where one has been freed: the weak pointer tells.
  if (const auto found = all.find(mesh.get()); found != all.end() && found->second.mesh.lock() == mesh) return found->second;
  std::erase_if(all, [](const auto& k) { return k.second.mesh.expired(); });
  return all[mesh.get()] = {mesh, std::make_shared<const TriangleTree>(*mesh), {}};
}

Bulk findBulk(const Mesh& mesh, const TriangleTree& all) {
  constexpr std::size_t kMost = 200'000;
  constexpr double kRounding = 1e-6;
  if (all.nodes().empty() || mesh.triangles.size() > kMost) return Bulk::Other;
  const TriangleTree::Node& root = all.nodes()[0];
  const double tolerance = kRounding * glm::length(glm::dvec3(root.high) - glm::dvec3(root.low));
  // How far a box or a triangle's corners reach along a facet's normal.
  bool flat = true;
  for (const glm::uvec3& facet : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[facet.x]);
    const glm::dvec3 cross = glm::cross(glm::dvec3(mesh.positions[facet.y]) - a, glm::dvec3(mesh.positions[facet.z]) - a);
    if (cross == glm::dvec3(0.0)) continue;
    const glm::dvec3 n = glm::normalize(cross);
    for (std::uint32_t k = 0; k < all.nodes().size();) {
      const TriangleTree::Node& node = all.nodes()[k];
      double highest = 0.0, lowest = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double x = n[c] * (static_cast<double>(node.low[c]) - a[c]), y = n[c] * (static_cast<double>(node.high[c]) - a[c]);
        highest += std::max(x, y);
        lowest += std::min(x, y);
      }
      if (highest <= tolerance && (!flat || lowest >= -tolerance)) {
        k = node.skip;
        continue;
      }
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
        for (int c = 0; c < 3; ++c) {
          const double height = glm::dot(n, glm::dvec3(mesh.positions[mesh.triangles[all.order()[t]][c]]) - a);
          if (height > tolerance) return Bulk::Other;
          if (height < -tolerance) flat = false;
        }
      ++k;
    }
  }
  return flat ? Bulk::Flat : mesh.closed ? Bulk::Convex : Bulk::Other;
}

}  // namespace

std::shared_ptr<const TriangleTree> treeOf(const std::shared_ptr<const Mesh>& mesh) {
  const std::lock_guard lock(knownMutex());
  return known(mesh).tree;
}

Bulk bulkOf(const std::shared_ptr<const Mesh>& mesh) {
  const std::lock_guard lock(knownMutex());
  Known& k = known(mesh);
  if (!k.bulk) k.bulk = findBulk(*mesh, *k.tree);
  return *k.bulk;
}

}  // namespace pitviper
