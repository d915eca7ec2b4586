#pragma once
// Where a body is and how it is turned, as a function of time.
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

namespace pitviper {

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
/// Body x along `forward`, z as near to up as possible (north where forward is vertical), then rolled.
glm::dquat orientationAlong(const glm::dvec3& forward, double roll_rad = 0.0);

struct Waypoint {
  double time_s = 0.0;
  glm::dvec3 position{0.0};
  std::optional<Attitude> attitude;  ///< absent: along the path
  double roll_rad = 0.0;             ///< used along the path
};

/// Smooth: cubic Hermite with finite-difference tangents (continuous velocity); Linear: straight legs.
/// Before the first and after the last waypoint a body stands still there. Times rise strictly.
class Motion {
 public:
  enum class Interpolation { Smooth, Linear };
  Motion() : Motion(Pose{}) {}
  explicit Motion(const Pose& fixed) : fixed_(fixed) {}
  Motion(std::vector<Waypoint> waypoints, Interpolation interpolation);
  Pose at(double time_s) const;
  const Pose& fixed() const { return fixed_; }  ///< where there are no waypoints
  const std::vector<Waypoint>& waypoints() const { return waypoints_; }
  Interpolation interpolation() const { return interpolation_; }

 private:
  glm::dvec3 tangent(size_t i) const;
  /// Direction of the last leg that moved up to this one, else of the next that moves: a body that stands keeps its heading.
  glm::dvec3 standingDirection(size_t leg) const;
  Pose fixed_;
  std::vector<Waypoint> waypoints_;
  Interpolation interpolation_ = Interpolation::Smooth;
};

}  // namespace pitviper
