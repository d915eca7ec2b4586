#pragma once
// The true form of a body whose mesh is faceted: a medium's path length is taken from it.
#include <glm/glm.hpp>

namespace pitviper {

/// Body axes, centred on the origin. Values as in sim/render/geometry/glsl/hit_medium.frag.glsl.
struct BodyForm {
  enum class Kind { Mesh = 0, Ellipsoid = 1, Cone = 2 };
  Kind kind = Kind::Mesh;
  /// Ellipsoid: semi-axes [m]. Cone (frustum, cylinder) along x: half length, base radius at -x, top radius at +x [m]. Mesh: unused.
  glm::dvec3 size{0.0};
};

}  // namespace pitviper
