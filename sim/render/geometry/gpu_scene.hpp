#pragma once
// Meshes and textures of a scenario on the GPU, shared by all cameras.
#include <memory>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/model/simulation.hpp"
#include "sim/render/geometry/mesh_clusters.hpp"

namespace pitviper {

/// In body axes [m].
struct BodyBox {
  glm::dvec3 low{0.0}, high{0.0};
};

class ShadowTrees;
struct SolidPrograms;

class GpuScene {
 public:
  explicit GpuScene(const Simulation& simulation);
  void bind() const;
  /// First triangle of an entity's mesh in the shared index buffer.
  std::uint32_t firstTriangle(int entity) const { return firstTriangle_[static_cast<size_t>(entity)]; }
  /// Around the entity's mesh and true form, a little larger, so that no line of sight through it slips past.
  const BodyBox& box(int entity) const { return boxes_[static_cast<size_t>(entity)]; }

  /// Of an entity's mesh as it is drawn; none where it is small.
  const std::vector<MeshCluster>& clusters(int entity) const { return clustered_[static_cast<size_t>(entity)]->clusters; }

  /// Of the simulation it was made for; made when first asked for.
  std::shared_ptr<const ShadowTrees> shadowTrees(const Simulation& simulation) const;
  /// Of what each pixel sees; made when first asked for.
  std::shared_ptr<const SolidPrograms> solidPrograms(const ShaderLibrary& library) const;

 private:
  Buffer vertices_, indices_, textureShapes_, texels_, levels_;  ///< read by programs
  Buffer drawn_, corners_;                                       ///< drawn: the last corner of a triangle carries its number
  VertexArray vertexArray_;
  std::vector<std::uint32_t> firstTriangle_;
  std::vector<BodyBox> boxes_;
  std::vector<std::shared_ptr<const ClusteredMesh>> clustered_;  ///< per entity, shared by those with the same mesh
  mutable std::shared_ptr<const ShadowTrees> shadowTrees_;
  mutable std::shared_ptr<const SolidPrograms> solidPrograms_;
};

}  // namespace pitviper
