#pragma once
// Meshes and textures of a scenario on the GPU, shared by all cameras.
#include <memory>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

class GpuScene {
 public:
  explicit GpuScene(const Simulation& simulation);
  void bind() const;
  /// First triangle of an entity's mesh in the shared index buffer.
  std::uint32_t firstTriangle(int entity) const { return firstTriangle_[static_cast<size_t>(entity)]; }

 private:
  Buffer vertices_, indices_, textureShapes_, texels_;
  VertexArray vertexArray_;
  std::vector<std::uint32_t> firstTriangle_;
};

}  // namespace pitviper
