#pragma once
// How many subpixels of a camera's picture may ask what shades them: where they are few, rays cost less than a map.
#include "sim/model/simulation.hpp"
#include "sim/render/shadow/shadow_reach.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// What looks at bodies. All must outlive it.
struct ShadowDemand {
  const View& view;
  const std::vector<char>& drawn;     ///< one flag per entity: the others are not seen
  const std::vector<double>& zoomed;  ///< one per entity: lines of its own view that see it, of a small body, else 0
};

/// Subpixels that a caster's shadow from a light covers, about: of what a box is wide on average over directions, where the ray away from the light comes
/// nearest to the eye, but no nearer than `nearest_m`, where what it falls on begins. The sun is the light after the last lamp. No more than the view has.
double shadowedSubpixels(const Simulation& simulation, const WorldState& state, const View& view, std::size_t caster, const ShadowBox& box, std::size_t light,
                         double nearest_m);

/// From a place to a body's box, 0 inside [m].
double distanceTo(const ShadowBox& box, const Pose& body, const glm::dvec3& place);

/// From an eye to where the shadow of a caster (ball) falls on a height field, about; infinite where it passes by [m].
double distanceToShadow(const Simulation& simulation, const WorldState& state, const glm::dvec3& eye, const glm::dvec3& centre, double radius_m,
                        std::size_t light, std::size_t field);

}  // namespace pitviper
