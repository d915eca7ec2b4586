#pragma once
// What acts on every body in flight: air, wind, gravity, the turning earth.
#include <optional>
#include <vector>

#include "sim/scene/geodesy.hpp"

namespace pitviper {

struct WindAt {
  double height_m = 0.0;         ///< above the ellipsoid
  glm::dvec3 velocity_m_s{0.0};  ///< where the air goes, in the scenario's east-north-up axes
};

/// Constant air and gravity: what closed forms are made for.
struct UniformEnvironment {
  double density_kg_m3 = 1.225;
  double soundSpeed_m_s = 340.294;
  double gravity_m_s2 = 9.80665;  ///< along -z everywhere; the ground is flat
};

struct FlightWorld {
  LocalFrame frame;
  std::vector<WindAt> wind;  ///< by rising height, straight between, held outside; one: the same everywhere; none: calm
  bool coriolis = true;
  double groundHeight_m = 0.0;  ///< above the ellipsoid
  std::optional<UniformEnvironment> uniform;
};

struct AirHere {
  double density_kg_m3 = 0.0, soundSpeed_m_s = 1.0;
  glm::dvec3 wind_m_s{0.0};
};

/// Heights are those of LocalFrame::height(), which is what scenes use.
double heightIn(const FlightWorld& world, const glm::dvec3& position);
glm::dvec3 upIn(const FlightWorld& world, const glm::dvec3& position);
AirHere airIn(const FlightWorld& world, const glm::dvec3& position);
/// Normal gravity of the ellipsoid, or the uniform one [m/s2].
glm::dvec3 gravityIn(const FlightWorld& world, const glm::dvec3& position);
/// Errors: FlightError for wind whose heights do not rise or numbers that are not finite.
void checkWorld(const FlightWorld& world);

}  // namespace pitviper
