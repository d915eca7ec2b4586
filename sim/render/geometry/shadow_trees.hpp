#pragma once
// The trees of all bodies that cast shadows, on the GPU, each once.
#include <cstdint>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/world/shadow_casters.hpp"

namespace pitviper {

class ShadowTrees {
 public:
  explicit ShadowTrees(const Simulation& simulation);
  struct Body {
    SelfShadow self = SelfShadow::Never;
    std::int32_t first = 0, end = 0;  ///< of the buffer; equal: casts none
    std::uint32_t triangles = 0;
    glm::dvec3 low{0.0}, high{0.0};  ///< of the opaque triangles, body axes [m]
    bool casts() const { return end > first; }
  };
  const Body& of(std::size_t entity) const { return bodies_[entity]; }
  void bind() const { nodes_.bindTexture(14, 4, true); }

 private:
  std::vector<Body> bodies_;
  Buffer nodes_;
};

}  // namespace pitviper
