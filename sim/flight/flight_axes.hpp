#pragma once
// How a body in flight is turned.
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sim/scene/motion.hpp"

namespace pitviper {

/// Body x along `forward`, z as near to `top` as it can be; where top lies along forward, as orientationAlong().
inline glm::dquat orientationWithTop(const glm::dvec3& forward, const glm::dvec3& top) {
  const glm::dvec3 x = glm::normalize(forward), across = glm::cross(top, x);
  // Below a part in 1e9 of top, its direction is rounding.
  if (!(glm::length(across) > 1e-9 * glm::length(top))) return orientationAlong(forward);
  const glm::dvec3 y = glm::normalize(across);
  return glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y))));
}

}  // namespace pitviper
