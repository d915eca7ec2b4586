#pragma once
// A path that has been worked out: where a body is at any time, smooth between points, with a stated course before the first and after the last.
#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <vector>

#include "sim/scene/motion.hpp"

namespace pitviper {

/// Local east-north-up frame [m, m/s, m/s2]; orientation as in Pose.
struct TrajectoryPoint {
  double time_s = 0.0;
  glm::dvec3 position{0.0}, velocity{0.0}, acceleration{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
};

/// Immutable; copies share their points. Lookup takes O(log n). Ends: Hold stands still there, GoOn keeps the velocity and the orientation that it
/// has there, Loop is the path again and again with the time between first and last point as its period, Vanish is not present, its pose that of the end.
class Trajectory {
 public:
  /// Cubic: Hermite through positions and velocities, whose accelerations step at points (those given are not used). Quintic: through accelerations too.
  /// A path with bounded derivatives is met within h^4/384 of its fourth derivative by a cubic, h^6/46080 of its sixth by a quintic, h the time between points
  /// (de Boor, A Practical Guide to Splines, ch. IV: error of Hermite interpolation).
  enum class Interpolation { Cubic, Quintic };
  /// Orientations are made unit length. Errors: std::invalid_argument for no points, numbers that are not finite, times that do not rise, an orientation of 0.
  explicit Trajectory(std::vector<TrajectoryPoint> points, AtEnd before = AtEnd::Hold, AtEnd after = AtEnd::Hold,
                      Interpolation interpolation = Interpolation::Quintic);

  /// Orientation: the shorter great circle between those of two points (slerp).
  Pose at(double time_s) const;
  glm::dvec3 velocityAt(double time_s) const;      ///< [m/s]; 0 where it holds or has vanished
  glm::dvec3 accelerationAt(double time_s) const;  ///< [m/s2]; 0 outside unless it loops
  bool presentAt(double time_s) const;             ///< at the ends themselves it is
  double begin_s() const { return points_->front().time_s; }
  double end_s() const { return points_->back().time_s; }
  AtEnd before() const { return before_; }
  AtEnd after() const { return after_; }
  const std::vector<TrajectoryPoint>& points() const { return *points_; }
  Trajectory withEnds(AtEnd before, AtEnd after) const;
  Interpolation interpolation() const { return interpolation_; }
  void addTo(Fingerprint& f) const;

 private:
  struct Place;
  Place placeOf(double time_s) const;
  std::shared_ptr<const std::vector<TrajectoryPoint>> points_;
  AtEnd before_, after_;
  Interpolation interpolation_;
};

}  // namespace pitviper
