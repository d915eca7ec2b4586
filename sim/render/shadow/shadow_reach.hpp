#pragma once
// Which body can shade which, and how a caster is seen from a light. All in the caster's body axes, in double precision.
#include <glm/glm.hpp>
#include <optional>

namespace pitviper {

/// A light as a caster sees it: the sun's unit direction, or a place with a radius within which nothing shades [m].
struct LightPlace {
  bool sun = false;
  glm::dvec3 at{0.0};
  double radius_m = 0.0;
};

struct ShadowBox {
  glm::dvec3 low{0.0}, high{0.0};
  glm::dvec3 centre() const { return 0.5 * (low + high); }
  double radius_m() const { return 0.5 * glm::length(high - low); }
};

/// False where nothing in `caster` can stand between the light and anything in `receiver` (a box in axes of its own, `axes` its columns and
/// `origin` its origin): the caster lies behind it, beside all lines to the light, or beyond a side that has both on its outside.
bool mayShade(const ShadowBox& caster, const ShadowBox& receiver, const glm::dmat3& axes, const glm::dvec3& origin, const LightPlace& light);

/// Rows that turn a place in body axes (1 as its fourth) into a caster's map: x, y in texels times w, depth times w from 0 at the caster's
/// nearest to 1 at its farthest, w: 1 for the sun, the distance along the map's axis for a point light.
struct ShadowProjection {
  glm::dvec4 row[4];
  double texelDepth = 0.0;  ///< a texel's larger side at the caster's far end, in units of depth
};

/// None where a light is so near that the caster fills more than 120 degrees of its view: rays alone must do.
std::optional<ShadowProjection> fitShadowMap(const ShadowBox& caster, const LightPlace& light, int texels);

}  // namespace pitviper
