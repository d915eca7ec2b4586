#pragma once
// Shadows in double precision: a ray from the surface to the light through the trees of all opaque bodies.
#include <vector>

#include "sim/world/ray_hits.hpp"
#include "sim/world/shadow_casters.hpp"

namespace pitviper {

class ShadowCaster {
 public:
  /// The simulation must outlive it. Cheap to make once the meshes' trees are there. Whether there are shadows at all is Terms::shadows.
  explicit ShadowCaster(const Simulation& simulation);
  /// False where something opaque stands between a surface and a light: `toLight` of unit length, in the local frame; nothing beyond
  /// `distance_m` counts (infinite for the sun; for a point light the distance less its radius, for the light is that large).
  bool lit(const WorldState& state, const Hit& from, const glm::dvec3& toLight, double distance_m) const;

 private:
  const Simulation& simulation_;
  struct Body {
    bool casts;
    SelfShadow self;
    std::shared_ptr<const TriangleTree> tree;
  };
  std::vector<Body> bodies_;
};

}  // namespace pitviper
