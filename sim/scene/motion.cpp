#include "sim/scene/motion.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

glm::dquat orientationFrom(const Attitude& a) {
  const glm::dquat heading = glm::angleAxis(0.5 * kPi - a.heading_rad, glm::dvec3(0, 0, 1));
  const glm::dquat pitch = glm::angleAxis(-a.pitch_rad, glm::dvec3(0, 1, 0));
  const glm::dquat roll = glm::angleAxis(a.roll_rad, glm::dvec3(1, 0, 0));
  return glm::normalize(heading * pitch * roll);
}

glm::dquat orientationAlong(const glm::dvec3& forward, double roll_rad) {
  const glm::dvec3 x = glm::normalize(forward);
  const bool vertical = std::abs(x.z) > 1.0 - 1e-12;
  const glm::dvec3 y = glm::normalize(glm::cross(vertical ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), x));
  const glm::dquat q = glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)));
  return glm::normalize(q * glm::angleAxis(roll_rad, glm::dvec3(1, 0, 0)));
}

Motion::Motion(std::vector<Waypoint> waypoints, Interpolation interpolation) : waypoints_(std::move(waypoints)), interpolation_(interpolation) {}

glm::dvec3 Motion::tangent(size_t i) const {
  const size_t last = waypoints_.size() - 1;
  auto slope = [this](size_t j) { return (waypoints_[j + 1].position - waypoints_[j].position) / (waypoints_[j + 1].time_s - waypoints_[j].time_s); };
  if (i == 0) return slope(0);
  if (i == last) return slope(last - 1);
  const double before = waypoints_[i].time_s - waypoints_[i - 1].time_s, after = waypoints_[i + 1].time_s - waypoints_[i].time_s;
  return (slope(i - 1) * after + slope(i) * before) / (before + after);
}

glm::dvec3 Motion::standingDirection(size_t leg) const {
  for (size_t j = leg + 1; j-- > 0;)
    if (const glm::dvec3 d = waypoints_[j + 1].position - waypoints_[j].position; glm::length(d) > 0.0) return d;
  for (size_t j = leg + 1; j + 1 < waypoints_.size(); ++j)
    if (const glm::dvec3 d = waypoints_[j + 1].position - waypoints_[j].position; glm::length(d) > 0.0) return d;
  return glm::dvec3(0.0);
}

Pose Motion::at(double t) const {
  if (waypoints_.empty()) return fixed_;
  const auto& first = waypoints_.front();
  if (waypoints_.size() == 1) return {first.position, first.attitude ? orientationFrom(*first.attitude) : fixed_.orientation};
  const double clamped = std::clamp(t, first.time_s, waypoints_.back().time_s);
  size_t i = 0;
  while (i + 2 < waypoints_.size() && clamped >= waypoints_[i + 1].time_s) ++i;
  const Waypoint &a = waypoints_[i], &b = waypoints_[i + 1];
  const double h = b.time_s - a.time_s, s = (clamped - a.time_s) / h;
  glm::dvec3 position, velocity;
  if (interpolation_ == Interpolation::Linear) {
    position = glm::mix(a.position, b.position, s);
    velocity = b.position - a.position;
  } else {
    const glm::dvec3 m0 = tangent(i) * h, m1 = tangent(i + 1) * h;
    const double s2 = s * s, s3 = s2 * s;
    position = (2 * s3 - 3 * s2 + 1) * a.position + (s3 - 2 * s2 + s) * m0 + (-2 * s3 + 3 * s2) * b.position + (s3 - s2) * m1;
    velocity = (6 * s2 - 6 * s) * a.position + (3 * s2 - 4 * s + 1) * m0 + (-6 * s2 + 6 * s) * b.position + (3 * s2 - 2 * s) * m1;
  }
  if (!(glm::length(velocity) > 0.0)) velocity = standingDirection(i);
  auto along = [&](const Waypoint& w) {
    if (w.attitude) return orientationFrom(*w.attitude);
    const double roll = a.roll_rad + s * (b.roll_rad - a.roll_rad);
    return glm::length(velocity) > 0.0 ? orientationAlong(velocity, roll) : fixed_.orientation;
  };
  return {position, glm::slerp(along(a), along(b), s)};
}

}  // namespace pitviper
