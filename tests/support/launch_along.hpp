#pragma once
// Launches of bodies that nothing carries.
#include "sim/flight/flights.hpp"
#include "sim/scene/motion.hpp"

namespace pitviper::test {

/// Heading clockwise from north, pitch up [rad], speed over ground.
inline Launch launchAlong(double time_s, const glm::dvec3& position, double heading_rad, double pitch_rad, double speed_m_s) {
  const glm::dvec3 ahead = orientationFrom({heading_rad, pitch_rad, 0.0}) * glm::dvec3(1.0, 0.0, 0.0);
  return {time_s, position, speed_m_s * ahead, ahead};
}

}  // namespace pitviper::test
