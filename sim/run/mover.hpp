#pragma once
// How what a scenario moves moves: exactly where its motion says so, else by differences of a stated step.
#include <functional>
#include <optional>

#include "sim/world/world.hpp"

namespace pitviper {

/// Of central differences [s]. A body that turns at 100 rad/s is told within 2e-5 of its acceleration ((w h)^2 / 6), and rounding of positions 1000 km away
/// stays below 1e-5 m/s and, of velocities, below 1e-6 m/s2.
constexpr double kDifference_s = 1e-4;

/// Something that a motion carries, in the local frame or in a carrier's axes. The simulation must outlive it.
class Mover {
 public:
  Mover(const Simulation& simulation, const Motion& motion, int carrier) : simulation_(simulation), motion_(motion), carrier_(carrier) {}
  bool movesItself() const { return !motion_.isStill(); }
  Pose poseAt(double time_s) const;
  /// Exact but for what a carrier's turning adds, which is a central difference.
  glm::dvec3 velocityAt(double time_s) const;
  /// Exact of a trajectory in the local frame, else a central difference of velocities; none where velocity jumps: at a corner.
  std::optional<glm::dvec3> accelerationAt(double time_s) const;
  /// Turning [rad/s] about x, y and z of the body, of an orientation over time (its own, or where a camera on it looks): a central difference; none where it
  /// jumps.
  using OrientationAt = std::function<glm::dquat(double time_s)>;
  std::optional<glm::dvec3> rateAt(double time_s, const OrientationAt& orientation) const;

 private:
  /// On which sides of a time it is on its way: where that begins or ends differences are one-sided.
  enum class Side { Both, Before, After };
  Side sideAt(double time_s) const;
  const Simulation& simulation_;
  const Motion& motion_;
  int carrier_;
};

/// Turning from one orientation to another as a vector in the axes of the first [rad]: half a turn at most.
glm::dvec3 turned(const glm::dquat& from, const glm::dquat& to);

/// Of a parabola through three positions at rising times: what it is at the middle one.
struct Slopes {
  glm::dvec3 velocity{0.0}, acceleration{0.0};
};
Slopes slopesThrough(double t0, const glm::dvec3& p0, double t1, const glm::dvec3& p1, double t2, const glm::dvec3& p2);

}  // namespace pitviper
