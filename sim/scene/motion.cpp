#include "sim/scene/motion.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/lifetime.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

glm::dquat orientationFrom(const Attitude& a) {
  const glm::dquat heading = glm::angleAxis(0.5 * kPi - a.heading_rad, glm::dvec3(0, 0, 1));
  const glm::dquat pitch = glm::angleAxis(-a.pitch_rad, glm::dvec3(0, 1, 0));
  const glm::dquat roll = glm::angleAxis(a.roll_rad, glm::dvec3(1, 0, 0));
  return glm::normalize(heading * pitch * roll);
}

Attitude attitudeOf(const glm::dquat& q) {
  const glm::dvec3 forward = q * glm::dvec3(1, 0, 0);
  Attitude a;
  a.pitch_rad = std::asin(std::clamp(forward.z, -1.0, 1.0));
  const double level = std::hypot(forward.x, forward.y);
  // Below a part in 1e12 the direction over ground is rounding.
  if (level > 1e-12) a.heading_rad = std::atan2(forward.x, forward.y);
  if (a.heading_rad < 0.0) a.heading_rad += 2.0 * kPi;
  if (a.heading_rad >= 2.0 * kPi) a.heading_rad = 0.0;  // a rounding west of north
  const glm::dquat rest = glm::inverse(orientationFrom(a)) * q;
  a.roll_rad = std::remainder(2.0 * std::atan2(rest.x, rest.w), 2.0 * kPi);
  return a;
}

glm::dquat orientationAlong(const glm::dvec3& forward, double roll_rad) {
  const glm::dvec3 x = glm::normalize(forward);
  const bool vertical = std::abs(x.z) > 1.0 - 1e-12;
  const glm::dvec3 y = glm::normalize(glm::cross(vertical ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), x));
  const glm::dquat q = glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)));
  return glm::normalize(q * glm::angleAxis(roll_rad, glm::dvec3(1, 0, 0)));
}

Motion::Motion(std::vector<Waypoint> waypoints, Interpolation interpolation, AtEnd before, AtEnd after)
    : waypoints_(std::move(waypoints)), interpolation_(interpolation), before_(before), after_(after) {}

Motion::Motion(const Trajectory& path) : path_(std::make_shared<const Trajectory>(path)) {}

Motion Motion::withSpin(const Spin& spin) const {
  Motion other = *this;
  other.spin_ = spin;
  return other;
}

AtEnd Motion::before() const { return path_ ? path_->before() : before_; }
AtEnd Motion::after() const { return path_ ? path_->after() : after_; }
double Motion::begin_s() const { return path_ ? path_->begin_s() : waypoints_.empty() ? 0.0 : waypoints_.front().time_s; }
double Motion::end_s() const { return path_ ? path_->end_s() : waypoints_.empty() ? 0.0 : waypoints_.back().time_s; }

bool Motion::presentAt(double t) const {
  if (!path_ && waypoints_.empty()) return true;
  return (before() != AtEnd::Vanish || t >= begin_s() - kSameTime_s) && (after() != AtEnd::Vanish || t <= end_s() + kSameTime_s);
}

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

/// On which leg, and how far past an end that is passed with its velocity.
struct Motion::Place {
  size_t leg = 0;
  double h = 1.0, s = 0.0, beyond_s = 0.0;
  bool still = false;
};

Motion::Place Motion::placeOf(double t) const {
  const double first = waypoints_.front().time_s, last = waypoints_.back().time_s;
  Place place;
  double within = std::clamp(t, first, last);
  if (within != t) {
    const AtEnd end = t < first ? before_ : after_;
    place.still = end == AtEnd::Hold || end == AtEnd::Vanish;
    if (end == AtEnd::GoOn) place.beyond_s = t - within;
    if (end == AtEnd::Loop) within = std::clamp(t - (last - first) * std::floor((t - first) / (last - first)), first, last);
  }
  while (place.leg + 2 < waypoints_.size() && within >= waypoints_[place.leg + 1].time_s) ++place.leg;
  place.h = waypoints_[place.leg + 1].time_s - waypoints_[place.leg].time_s;
  place.s = (within - waypoints_[place.leg].time_s) / place.h;
  return place;
}

Pose Motion::at(double t) const {
  Pose pose = path_ ? path_->at(t) : alongAt(t);
  if (spin_) pose.orientation = glm::normalize(pose.orientation * glm::angleAxis(std::remainder(spin_->angleAt(t), 2.0 * kPi), spin_->axis));
  return pose;
}

glm::dvec3 Motion::velocityAt(double t) const {
  if (path_) return path_->velocityAt(t);
  if (waypoints_.size() < 2) return glm::dvec3(0.0);
  const Place p = placeOf(t);
  if (p.still) return glm::dvec3(0.0);
  const Waypoint &a = waypoints_[p.leg], &b = waypoints_[p.leg + 1];
  if (interpolation_ == Interpolation::Linear) return (b.position - a.position) / p.h;
  const double s = p.s, s2 = s * s;
  return (6 * s2 - 6 * s) / p.h * (a.position - b.position) + (3 * s2 - 4 * s + 1) * tangent(p.leg) + (3 * s2 - 2 * s) * tangent(p.leg + 1);
}

Pose Motion::alongAt(double t) const {
  if (waypoints_.empty()) return fixed_;
  const auto& first = waypoints_.front();
  if (waypoints_.size() == 1) return {first.position, first.attitude ? orientationFrom(*first.attitude) : fixed_.orientation};
  const Place place = placeOf(t);
  const size_t i = place.leg;
  const Waypoint &a = waypoints_[i], &b = waypoints_[i + 1];
  const double h = place.h, s = place.s;
  glm::dvec3 position, velocity;  // velocity by s
  if (interpolation_ == Interpolation::Linear) {
    position = glm::mix(a.position, b.position, s);
    velocity = b.position - a.position;
  } else {
    const glm::dvec3 m0 = tangent(i) * h, m1 = tangent(i + 1) * h;
    const double s2 = s * s, s3 = s2 * s;
    position = (2 * s3 - 3 * s2 + 1) * a.position + (s3 - 2 * s2 + s) * m0 + (-2 * s3 + 3 * s2) * b.position + (s3 - s2) * m1;
    velocity = (6 * s2 - 6 * s) * a.position + (3 * s2 - 4 * s + 1) * m0 + (-6 * s2 + 6 * s) * b.position + (3 * s2 - 2 * s) * m1;
  }
  position += velocity / h * place.beyond_s;
  if (!(glm::length(velocity) > 0.0)) velocity = standingDirection(i);
  auto along = [&](const Waypoint& w) {
    if (w.attitude) return orientationFrom(*w.attitude);
    const double roll = a.roll_rad + s * (b.roll_rad - a.roll_rad);
    return glm::length(velocity) > 0.0 ? orientationAlong(velocity, roll) : fixed_.orientation;
  };
  return {position, glm::slerp(along(a), along(b), s)};
}

}  // namespace pitviper
