#include "sim/scene/gravity.hpp"

#include <GeographicLib/NormalGravity.hpp>

namespace pitviper {

glm::dvec3 normalGravity(const LocalFrame& frame, const glm::dvec3& local) {
  const glm::dvec3 at = frame.toEcef(local);
  glm::dvec3 gravity;
  GeographicLib::NormalGravity::WGS84().U(at.x, at.y, at.z, gravity.x, gravity.y, gravity.z);
  return glm::transpose(frame.ecefFromLocal()) * gravity;
}

glm::dvec3 earthRotation(const LocalFrame& frame) {
  return glm::transpose(frame.ecefFromLocal()) * glm::dvec3(0.0, 0.0, GeographicLib::NormalGravity::WGS84().AngularVelocity());
}

glm::dvec3 coriolisAcceleration(const glm::dvec3& earthRotation_rad_s, const glm::dvec3& velocity_m_s) {
  return -2.0 * glm::cross(earthRotation_rad_s, velocity_m_s);
}

}  // namespace pitviper
