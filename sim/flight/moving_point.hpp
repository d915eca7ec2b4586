#pragma once
// Something that moves, as guidance and closest approaches see it.
#include <functional>
#include <glm/glm.hpp>

#include "sim/scene/trajectory.hpp"

namespace pitviper {

/// Local east-north-up frame [m, m/s, m/s2].
struct MovingPoint {
  glm::dvec3 position{0.0}, velocity{0.0}, acceleration{0.0};
};

/// Of the scenario's time [s].
using PointMotion = std::function<MovingPoint(double time_s)>;

/// A trajectory as such; it keeps its own copy (points are shared).
inline PointMotion motionOf(const Trajectory& path) {
  return [path](double t) { return MovingPoint{path.at(t).position, path.velocityAt(t), path.accelerationAt(t)}; };
}

}  // namespace pitviper
