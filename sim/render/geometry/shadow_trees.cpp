#include "sim/render/geometry/shadow_trees.hpp"

#include <bit>
#include <map>

namespace pitviper {
namespace {

glm::uvec4 packed(const glm::vec3& v, std::uint32_t w) {
  return {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z), w};
}

/// As sim/render/shadow/glsl/shadow_maps.glsl reads it: (low, where to go on after a miss), (high, triangles), then three corners a triangle.
void append(std::vector<glm::uvec4>& out, const Mesh& mesh, const TriangleTree& tree) {
  const auto root = static_cast<std::uint32_t>(out.size());
  const auto& nodes = tree.nodes();
  std::vector<std::uint32_t> at(nodes.size() + 1, root);
  for (size_t n = 0; n < nodes.size(); ++n) at[n + 1] = at[n] + 2 + 3 * nodes[n].count;
  for (const TriangleTree::Node& node : nodes) {
    out.push_back(packed(node.low, at[node.skip]));
    out.push_back(packed(node.high, node.count));
    for (std::uint32_t k = 0; k < node.count; ++k)
      for (int c = 0; c < 3; ++c) out.push_back(packed(mesh.positions[mesh.triangles[tree.order()[node.first + k]][c]], 0));
  }
}

}  // namespace

ShadowTrees::ShadowTrees(const Simulation& simulation) {
  std::vector<glm::uvec4> nodes;
  std::map<const TriangleTree*, std::pair<std::int32_t, std::int32_t>> placed;
  const auto casters = shadowCasters(simulation);
  for (size_t e = 0; e < casters.size(); ++e) {
    Body& body = bodies_.emplace_back();
    const TriangleTree* tree = casters[e].tree.get();
    if (!tree || tree->nodes().empty()) continue;
    auto [place, fresh] = placed.try_emplace(tree);
    if (fresh) {
      place->second.first = static_cast<std::int32_t>(nodes.size());
      append(nodes, *simulation.entities[e].mesh, *tree);
      place->second.second = static_cast<std::int32_t>(nodes.size());
    }
    body = {casters[e].self,      place->second.first,  place->second.second, static_cast<std::uint32_t>(tree->order().size()),
            tree->nodes()[0].low, tree->nodes()[0].high};
  }
  nodes_.upload(nodes);
}

}  // namespace pitviper
