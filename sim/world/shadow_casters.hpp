#pragma once
// What casts shadows: the opaque triangles of bodies. Transparent surfaces and media cast none. A light's rays are straight lines, the sun
// and lights are points: shadows have no half-shade.
#include <memory>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/scene/triangle_tree.hpp"

namespace pitviper {

/// How a body shades itself. A ray begins on the light's side of the facet it leaves. Where it counts one side only, it is stopped by
/// triangles whose side towards it is the side it began on: so neither the facet itself nor its neighbours on a smooth convex surface,
/// however coarse, darken what the surface's own normal says is lit, and no distance has to be left free.
enum class SelfShadow {
  Never,     ///< flat
  Inside,    ///< convex and closed: seen from inside only, one side
  OneSided,  ///< closed, or a height field: one side
  Open       ///< both sides; one side from facets that face away from a light which the surface's normal faces
};

/// `whole`: all surfaces are opaque.
SelfShadow selfShadow(const Entity& entity, bool whole);

struct ShadowCasterBody {
  std::shared_ptr<const TriangleTree> tree;  ///< of its opaque triangles; null: it casts none
  SelfShadow self = SelfShadow::Never;
};

/// One per entity.
std::vector<ShadowCasterBody> shadowCasters(const Simulation& simulation);

/// False where no surface can be shaded: no light or no surface that reflects it, nothing opaque, the scenario turns shadows off, or its one
/// body is flat, or convex with no camera or probe ever within its bounding sphere.
bool canHaveShadows(const Simulation& simulation);

}  // namespace pitviper
