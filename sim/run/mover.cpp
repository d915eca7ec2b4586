#include "sim/run/mover.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

Pose Mover::poseAt(double t) const {
  const Pose own = motion_.at(t);
  return carrier_ >= 0 ? composed(poseOf(simulation_, carrier_, t), own) : own;
}

glm::dvec3 Mover::velocityAt(double t) const {
  const glm::dvec3 own = motion_.velocityAt(t);
  if (carrier_ < 0) return own;
  const glm::dvec3 at = motion_.at(t).position;
  const glm::dvec3 before = poseOf(simulation_, carrier_, t - kDifference_s).orientation * at,
                   after = poseOf(simulation_, carrier_, t + kDifference_s).orientation * at;
  return velocityOf(simulation_, carrier_, t) + poseOf(simulation_, carrier_, t).orientation * own + (after - before) / (2.0 * kDifference_s);
}

Mover::Side Mover::sideAt(double t) const {
  if (motion_.isStill()) return Side::Both;
  const double begin = motion_.begin_s(), end = motion_.end_s();
  if (end <= begin) return Side::Both;  // it only spins
  // An end within a nanosecond is that of the row: sums of steps round.
  if (std::abs(t - begin) < kSameTime_s) return Side::After;
  return std::abs(t - end) < kSameTime_s ? Side::Before : Side::Both;
}

namespace {

/// A difference quotient by the whole step, unless half the step gives another: where what is differenced jumps that is twice as much, where only its slope
/// jumps, the same mean. A quarter tells them apart; below `rounding` it is no matter.
template <class Quotient>
std::optional<glm::dvec3> unlessItJumps(const Quotient& quotient, double rounding) {
  const glm::dvec3 whole = quotient(kDifference_s), half = quotient(0.5 * kDifference_s);
  if (glm::distance(whole, half) > 0.25 * glm::length(whole) + rounding) return std::nullopt;
  return whole;
}

/// Of second order, from differences between two times about the one that is meant: central, or on one side.
template <class Side, class Difference>
glm::dvec3 slope(Side side, double h, const Difference& difference) {
  if (side == Side::Both) return difference(-h, h) / (2.0 * h);
  const double s = side == Side::After ? 1.0 : -1.0;
  return s * (4.0 * difference(0.0, s * h) - difference(0.0, s * 2.0 * h)) / (2.0 * h);
}

}  // namespace

std::optional<glm::dvec3> Mover::accelerationAt(double t) const {
  if (carrier_ < 0 && motion_.path()) return motion_.path()->accelerationAt(t);
  if (carrier_ < 0 && motion_.isStill()) return glm::dvec3(0.0);
  constexpr double kRounding_m_s2 = 1e-3;
  return unlessItJumps([&](double h) { return slope(sideAt(t), h, [&](double from, double to) { return velocityAt(t + to) - velocityAt(t + from); }); },
                       kRounding_m_s2);
}

std::optional<glm::dvec3> Mover::rateAt(double t, const OrientationAt& orientation) const {
  constexpr double kRounding_rad_s = 1e-9;
  return unlessItJumps(
      [&](double h) { return slope(sideAt(t), h, [&](double from, double to) { return turned(orientation(t + from), orientation(t + to)); }); },
      kRounding_rad_s);
}

glm::dvec3 turned(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat by = glm::inverse(from) * to;
  if (by.w < 0.0) by = -by;
  const glm::dvec3 axis(by.x, by.y, by.z);
  const double sine = glm::length(axis);
  return sine > 0.0 ? axis * (2.0 * std::atan2(sine, by.w) / sine) : axis;
}

Slopes slopesThrough(double t0, const glm::dvec3& p0, double t1, const glm::dvec3& p1, double t2, const glm::dvec3& p2) {
  const double before = t1 - t0, after = t2 - t1;
  const glm::dvec3 into = (p1 - p0) / before, out = (p2 - p1) / after;
  return {(into * after + out * before) / (before + after), 2.0 * (out - into) / (before + after)};
}

}  // namespace pitviper
