#pragma once
// When two things that move pass each other, and how closely.
#include <optional>

#include "sim/flight/moving_point.hpp"

namespace pitviper {

struct ClosestApproach {
  double time_s = 0.0, distance_m = 0.0;
};

/// Time into a step [s] at which the distance has its minimum; nothing where distance does not fall at the begin and rise at the end. Relative positions and
/// velocities at both ends; between them the relative motion is the cubic through these, in error by step^4/384 of its fourth derivative, and the minimum is
/// where range rate is 0, found by bisection to rounding.
std::optional<double> closestInStep(const glm::dvec3& r0, const glm::dvec3& v0, const glm::dvec3& r1, const glm::dvec3& v1, double step_s);

/// The least distance from begin to end, looked for in steps: passes that begin and end within one are not seen.
/// Errors: std::invalid_argument for a step that is not above 0 or an end before the begin.
ClosestApproach closestApproach(const PointMotion& a, const PointMotion& b, double begin_s, double end_s, double step_s);

}  // namespace pitviper
