#include "sim/flight/guidance.hpp"

#include <algorithm>
#include <cmath>

#include "sim/flight/flight_error.hpp"
#include "sim/scene/gravity.hpp"

namespace pitviper {
namespace {

glm::dvec3 lawCommand(const GuidanceOptions& options, const MovingPoint& own, const glm::dvec3& r, const glm::dvec3& relativeVelocity) {
  const double range = glm::length(r), speed = glm::length(own.velocity);
  const glm::dvec3 sight = r / range, turn = glm::cross(r, relativeVelocity) / (range * range);
  switch (options.law) {
    case GuidanceLaw::TrueProportional:
      return options.navigationConstant * std::max(-glm::dot(sight, relativeVelocity), 0.0) * glm::cross(turn, sight);
    case GuidanceLaw::PureProportional:
      return options.navigationConstant * glm::cross(turn, own.velocity);
    case GuidanceLaw::Pursuit: {
      if (!(speed > 0.0)) return glm::dvec3(0.0);
      const glm::dvec3 ahead = own.velocity / speed;
      return glm::cross(turn, own.velocity) + options.pursuitGain_per_s * speed * (sight - glm::dot(sight, ahead) * ahead);
    }
  }
  return glm::dvec3(0.0);
}

}  // namespace

glm::dvec3 guidanceCommand(const GuidanceOptions& options, const MovingPoint& own, const MovingPoint& target, const glm::dvec3& gravity_m_s2) {
  const glm::dvec3 r = target.position - own.position, relativeVelocity = target.velocity - own.velocity;
  glm::dvec3 command(0.0);
  if (glm::length(r) > options.blindRange_m) command = lawCommand(options, own, r, relativeVelocity);
  if (options.gravityCompensation) {
    const double speed2 = glm::dot(own.velocity, own.velocity);
    command -= speed2 > 0.0 ? gravity_m_s2 - own.velocity * (glm::dot(gravity_m_s2, own.velocity) / speed2) : glm::dvec3(0.0);
  }
  const double size = glm::length(command), most = options.most_g * kStandardGravity;
  return size > most ? command * (most / size) : command;
}

void checkGuidance(const GuidanceOptions& o) {
  checkFlight(o.navigationConstant >= 1.0 && o.navigationConstant <= 10.0, "navigation_constant", o.navigationConstant, "1 to 10", "3 to 5 are usual");
  checkFlight(std::isfinite(o.pursuitGain_per_s) && o.pursuitGain_per_s >= 0.0, "pursuit_gain", o.pursuitGain_per_s, "0 or more", "give a positive gain");
  checkFlight(std::isfinite(o.begin_s) && o.begin_s >= 0.0, "guided_from", o.begin_s, "a time since launch", "give 0 or more");
  checkFlight(std::isfinite(o.timeConstant_s) && o.timeConstant_s >= 0.0, "time_constant", o.timeConstant_s, "0 or more", "0 is without lag");
  checkFlight(o.most_g >= 0.0, "most_g", o.most_g, "0 or more", "give the limit as a positive number");
  checkFlight(std::isfinite(o.blindRange_m) && o.blindRange_m > 0.0, "blindRange_m", o.blindRange_m, "a range above 0", "a few metres");
}

}  // namespace pitviper
