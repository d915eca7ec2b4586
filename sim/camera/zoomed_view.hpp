#pragma once
// Views that look at a small thing from where a picture is taken.
#include "sim/world/view.hpp"

namespace pitviper {

/// What a zoomed view looks at [local frame, m].
struct Ball {
  int entity = -1;
  int surface = -1;  ///< of the entity, where a part of it is meant
  glm::dvec3 centre{0.0};
  double radius_m = 0.0;
  double lines_per_m = 0.0;  ///< across it, as finely as it has to be sampled
};

/// What bounds a body now.
Ball ballOf(const Simulation& simulation, const WorldState& state, int entity);
/// The smallest ball that holds two, of the first's entity.
Ball around(const Ball& a, const Ball& b);
/// Diameter of a ball [subpixels of the view]; infinite where it comes near the camera's plane.
double extentOf(const Ball& ball, const View& view);
/// From the same place as a view, turned so that a ball fills the picture of size x size lines, and rolled by an angle that no edge of a scene shares.
View zoomedView(const Ball& ball, const View& view, int size);
/// Whether a direction (local frame) passes through a view's film.
bool looksAt(const View& view, const glm::dvec3& direction);
/// Whether the cones around two balls from a place overlap, each so many times as wide.
bool mayOverlap(const Ball& a, const Ball& b, const glm::dvec3& from, double room);

}  // namespace pitviper
