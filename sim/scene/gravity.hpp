#pragma once
// Gravity and rotation of the earth, in the local frame of a scenario.
#include <glm/glm.hpp>

#include "sim/scene/geodesy.hpp"

namespace pitviper {

/// Standard gravity [m/s2], exact: the "g" of limits and loads (3rd CGPM, 1901).
constexpr double kStandardGravity = 9.80665;

/// Normal gravity of the WGS 84 ellipsoid at a local position [m/s2], in local axes: attraction and centrifugal acceleration, as a body feels them that turns
/// with the earth. Source: NGA.STND.0036 (WGS 84), section 4: the closed formula of Somigliana and its continuation upwards, as GeographicLib has it.
/// Valid: outside the ellipsoid; the true field deviates from it by about 1e-4 of itself.
glm::dvec3 normalGravity(const LocalFrame& frame, const glm::dvec3& local);

/// Rotation of the earth in local axes [rad/s]: 7.292115e-5 about its axis (WGS 84).
glm::dvec3 earthRotation(const LocalFrame& frame);

/// -2 w x v [m/s2] for a velocity relative to the ground, both in local axes.
glm::dvec3 coriolisAcceleration(const glm::dvec3& earthRotation_rad_s, const glm::dvec3& velocity_m_s);

}  // namespace pitviper
