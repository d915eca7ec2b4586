#include "sensors/gimbal/pointing.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kTurn = 2.0 * kPi;

std::string degrees(double angle_rad) { return print("%.4g deg", angle_rad * 180.0 / kPi); }

double azimuthNearest(double azimuth_rad, double near_rad) { return azimuth_rad + kTurn * std::round((near_rad - azimuth_rad) / kTurn); }

}  // namespace

glm::dvec3 directionOf(const glm::dvec2& a) { return {std::cos(a.y) * std::cos(a.x), std::cos(a.y) * std::sin(a.x), std::sin(a.y)}; }

glm::dvec2 anglesOf(const glm::dvec3& d) {
  const double level = std::hypot(d.x, d.y);
  return {level > 0.0 ? std::atan2(d.y, d.x) : 0.0, std::atan2(d.z, level)};
}

glm::dquat orientationOf(const glm::dvec2& a, double roll_rad) {
  const glm::dquat azimuth = glm::angleAxis(a.x, glm::dvec3(0, 0, 1)), elevation = glm::angleAxis(-a.y, glm::dvec3(0, 1, 0));
  return azimuth * elevation * glm::angleAxis(roll_rad, glm::dvec3(1, 0, 0));
}

glm::dvec2 turned(const glm::dvec2& angles, const glm::dvec2& offset) {
  if (offset == glm::dvec2(0.0)) return angles;
  glm::dvec2 there = anglesOf(orientationOf(angles) * directionOf(offset));
  there.x = azimuthNearest(there.x, angles.x);
  return there;
}

std::optional<glm::dvec2> demandOf(const Pose& carrier, const glm::dvec3& cameraPosition, const glm::dvec3& targetPosition) {
  const glm::dvec3 line = targetPosition - cameraPosition;
  if (!(glm::length(line) > 0.0)) return std::nullopt;
  return anglesOf(glm::conjugate(carrier.orientation) * line);
}

double azimuthNear(const GimbalLimits& limits, double azimuth_rad, double near_rad) {
  const double nearest = azimuthNearest(azimuth_rad, near_rad);
  return std::abs(nearest) <= limits.azimuth_rad ? nearest : azimuthNearest(azimuth_rad, 0.0);
}

glm::dvec2 withinLimits(const GimbalLimits& limits, const glm::dvec2& a) {
  return {std::clamp(a.x, -limits.azimuth_rad, limits.azimuth_rad), std::clamp(a.y, limits.elevation_rad.x, limits.elevation_rad.y)};
}

glm::dvec2 beyondLimits(const GimbalLimits& limits, const glm::dvec2& a) { return a - withinLimits(limits, a); }

void requireWithinLimits(const GimbalLimits& limits, const glm::dvec2& a, const std::string& camera, const Location& where) {
  const glm::dvec2 beyond = beyondLimits(limits, a);
  if (beyond == glm::dvec2(0.0)) return;
  std::string wrong = "camera '" + camera + "': its gimbal cannot see its target at the start:", expected;
  const auto add = [&](double past, const char* axis, const char* side, double demanded, double least, double most) {
    if (past == 0.0) return;
    wrong += std::string(expected.empty() ? " " : " and ") + degrees(std::abs(past)) + " beyond its limit in " + axis + ", to the " + side + " (it lies at " +
             degrees(demanded) + ")";
    expected += std::string(expected.empty() ? "" : ", ") + axis + " from " + degrees(least) + " to " + degrees(most);
  };
  add(beyond.x, "azimuth", beyond.x > 0.0 ? "left" : "right", a.x, -limits.azimuth_rad, limits.azimuth_rad);
  add(beyond.y, "elevation", beyond.y > 0.0 ? "top" : "bottom", a.y, limits.elevation_rad.x, limits.elevation_rad.y);
  throw UserError(where, wrong, expected, "turn the carrier toward the target, or widen the limits");
}

glm::dvec3 directionOfFilm(const Pinhole& film, const glm::dvec2& at) { return glm::normalize(glm::dvec3(1.0, -film.tanX(at.x), film.tanY(at.y))); }

std::optional<glm::dvec2> filmOf(const Pinhole& film, const glm::dvec3& d) {
  if (!(d.x > 0.0)) return std::nullopt;
  return glm::dvec2(0.5 * film.width - d.y / d.x * film.focalLength_m / film.pitchX_m, 0.5 * film.height - d.z / d.x * film.focalLength_m / film.pitchY_m);
}

}  // namespace pitviper
