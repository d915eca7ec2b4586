#pragma once
// Directions as a gimbal has them. Carrier and camera axes are a body's: x forward (for a camera: along its line of sight), y left, z up. Azimuth turns left
// about z, elevation then up; roll is about the line of sight, right side down. All in radians.
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>

#include "sim/parameters/error.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/motion.hpp"

namespace pitviper {

struct GimbalLimits {
  double azimuth_rad = std::numeric_limits<double>::infinity();       ///< most, each way; infinite: all round
  glm::dvec2 elevation_rad{-1.5707963267948966, 1.5707963267948966};  ///< least, most
  double rate_rad_s = 0.0;                                            ///< most, of either axis; 0: unlimited
  double acceleration_rad_s2 = 0.0;                                   ///< most, of either axis; 0: unlimited
};

/// Unit vector of azimuth and elevation.
glm::dvec3 directionOf(const glm::dvec2& angles_rad);
/// Azimuth in (-pi, pi] and elevation of a vector that is not 0; straight up or down the azimuth is 0.
glm::dvec2 anglesOf(const glm::dvec3& direction);
/// The outer axes from the inner ones: Rz(azimuth) Ry(-elevation) Rx(roll), x along directionOf(angles).
glm::dquat orientationOf(const glm::dvec2& angles_rad, double roll_rad = 0.0);
/// The direction that lies `offset` (left, up) from the line of `angles` in the line's own axes, so that 1 degree is 1 degree at any elevation; its azimuth
/// is the one nearest to that of `angles`.
glm::dvec2 turned(const glm::dvec2& angles_rad, const glm::dvec2& offset_rad);

/// Angles in the carrier's axes from a camera to a target, both in the carrier's local frame [m]; nothing where they are at one place.
std::optional<glm::dvec2> demandOf(const Pose& carrier, const glm::dvec3& cameraPosition, const glm::dvec3& targetPosition);

/// The azimuth among those a whole turn apart that is nearest to `near` and within the limits, else `azimuth` in (-pi, pi] as it is.
double azimuthNear(const GimbalLimits& limits, double azimuth_rad, double near_rad);
glm::dvec2 withinLimits(const GimbalLimits& limits, const glm::dvec2& angles_rad);
/// How far beyond its limits a direction lies, by axis: positive to the left or up, negative to the right or down, 0 within.
glm::dvec2 beyondLimits(const GimbalLimits& limits, const glm::dvec2& angles_rad);
/// Errors: UserError at `where` for a direction beyond the limits, which says by how much and on which axis.
void requireWithinLimits(const GimbalLimits& limits, const glm::dvec2& angles_rad, const std::string& camera, const Location& where);

/// Direction in camera axes of a film position [pixels from the top left corner], and back; nothing for what is behind the film's plane.
glm::dvec3 directionOfFilm(const Pinhole& film, const glm::dvec2& at_px);
std::optional<glm::dvec2> filmOf(const Pinhole& film, const glm::dvec3& direction);

}  // namespace pitviper
