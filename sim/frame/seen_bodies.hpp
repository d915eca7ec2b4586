#pragma once
// What a camera sees of each body, found by rays in double precision: nothing is drawn.
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

enum class HowSeen {
  Absent,     ///< not there at that time
  Carrier,    ///< carries the camera, which does not see it
  Behind,     ///< all of it behind the camera
  OutOfView,  ///< beside the film
  TooNear,    ///< all of it nearer than the camera draws
  Hidden,     ///< no place looked at is seen
  InView
};

struct BodySight {
  HowSeen sight = HowSeen::OutOfView;
  glm::dvec3 size_m{0.0};  ///< of the box around it along its own axes
  double range_m = 0.0;    ///< to the middle of its bounding sphere; from within that sphere: to the nearest place looked at
  double width_px = 0.0;   ///< of the box around its outline on the plane of the film, whatever the film's edges cut off;
  double height_px = 0.0;  ///< infinite where it reaches beside or behind the camera
  bool cut = false;        ///< partly beyond the film
  double hidden = 0.0;     ///< share of the places within the film that others hide
  int hiddenBy = -1;       ///< the body that hides most of them, or -1
  int through = -1;        ///< a transparent body before most of those that are seen, or -1
};

/// One for each entity. Rays go through a grid over the film and to places spread over each body by area: what is smaller than both may be
/// seen between them, so that 'hidden' means all of some dozens of places, and its share is good to about 5 % of a body.
std::vector<BodySight> bodiesSeen(const Simulation& simulation, const Camera& camera, const WorldState& state);

}  // namespace pitviper
