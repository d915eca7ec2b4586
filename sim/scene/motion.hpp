#pragma once
// Where a body is and how it is turned, as a function of time.
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "sim/parameters/time_course.hpp"

namespace pitviper {

class Trajectory;

/// What lies beyond the ends of a motion: it stands still there, keeps its velocity and attitude, begins anew (its period is from the first point to the last),
/// or what moves so is not there.
enum class AtEnd { Hold, GoOn, Loop, Vanish };

/// Body axes: x forward, y left, z up. Orientation turns body directions into local east-north-up ones.
struct Pose {
  glm::dvec3 position{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
};

/// Heading clockwise from north, pitch up, roll right wing down [rad].
struct Attitude {
  double heading_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;
};

glm::dquat orientationFrom(const Attitude& attitude);
/// Heading from 0 to 2 pi, pitch within a quarter turn, roll within half a turn [rad]; of a body that points straight up or down the heading is that of its
/// roll.
Attitude attitudeOf(const glm::dquat& orientation);
/// Body x along `forward`, z as near to up as possible (north where forward is vertical), then rolled.
glm::dquat orientationAlong(const glm::dvec3& forward, double roll_rad = 0.0);

struct Waypoint {
  double time_s = 0.0;
  glm::dvec3 position{0.0};
  std::optional<Attitude> attitude;  ///< absent: along the path
  double roll_rad = 0.0;             ///< used along the path
};

/// Turning about an axis of the body, on top of the attitude that it has on its way, by any number of turns: `angle_rad` over time, or an even rate.
struct Spin {
  glm::dvec3 axis{1.0, 0.0, 0.0};  ///< unit, body axes (x forward, y left, z up)
  double rate_rad_s = 0.0;         ///< right-handed about the axis
  double from_s = 0.0;             ///< at which an even rate has turned by nothing
  TimeCourse angle_rad;            ///< instead of a rate, unless empty
  double angleAt(double time_s) const { return angle_rad.empty() ? rate_rad_s * (time_s - from_s) : angle_rad.at(time_s); }
};

/// Smooth: cubic Hermite with finite-difference tangents (continuous velocity); Linear: straight legs. Times of waypoints rise strictly.
class Motion {
 public:
  enum class Interpolation { Smooth, Linear };
  Motion() : Motion(Pose{}) {}
  explicit Motion(const Pose& fixed) : fixed_(fixed) {}
  Motion(std::vector<Waypoint> waypoints, Interpolation interpolation, AtEnd before = AtEnd::Hold, AtEnd after = AtEnd::Hold);
  /// As worked out, with that path's own ends.
  explicit Motion(const Trajectory& path);
  Motion withSpin(const Spin& spin) const;

  Pose at(double time_s) const;
  glm::dvec3 velocityAt(double time_s) const;                                 ///< [m/s], in the axes of the positions; 0 where it holds or has vanished
  bool presentAt(double time_s) const;                                        ///< false beyond an end at which it vanishes; at the end itself it is
  bool isStill() const { return waypoints_.size() < 2 && !path_ && !spin_; }  ///< the same pose always
  const Pose& fixed() const { return fixed_; }                                ///< where there are no waypoints and no path
  const std::vector<Waypoint>& waypoints() const { return waypoints_; }
  const Trajectory* path() const { return path_.get(); }
  const std::optional<Spin>& spin() const { return spin_; }
  Interpolation interpolation() const { return interpolation_; }
  AtEnd before() const;
  AtEnd after() const;
  /// Between which it moves: 0 and 0 of a fixed one.
  double begin_s() const;
  double end_s() const;

 private:
  Pose alongAt(double time_s) const;
  glm::dvec3 tangent(size_t i) const;
  /// Direction of the last leg that moved up to this one, else of the next that moves: a body that stands keeps its heading.
  glm::dvec3 standingDirection(size_t leg) const;
  struct Place;
  Place placeOf(double time_s) const;
  Pose fixed_;
  std::vector<Waypoint> waypoints_;
  Interpolation interpolation_ = Interpolation::Smooth;
  AtEnd before_ = AtEnd::Hold, after_ = AtEnd::Hold;
  std::shared_ptr<const Trajectory> path_;
  std::optional<Spin> spin_;
};

}  // namespace pitviper
