#pragma once
// Flights: a body is launched, pushed, braked, guided, and comes down, hits or passes by.
#include <limits>
#include <memory>
#include <optional>

#include "sim/flight/closest_approach.hpp"
#include "sim/flight/flight_world.hpp"
#include "sim/flight/flying_body.hpp"
#include "sim/flight/guidance.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

struct Launch {
  double time_s = 0.0;  ///< of the scenario
  glm::dvec3 position{0.0}, velocity{0.0};
  glm::dvec3 direction{1.0, 0.0, 0.0};  ///< where it points as long as no air flows past it
};

/// Released by something that moves: `offset` [m] and `ejection` [m/s] in its body axes (x forward, y left, z up); its turning adds no velocity.
Launch launchFrom(double time_s, const Pose& parent, const glm::dvec3& parentVelocity, const glm::dvec3& offset, const glm::dvec3& ejection);

/// How a body stands about its way through the air. WithLift: z along lift; one that needs none stands upright (a tenth of g of "up" is added to lift, so that
/// the change between them is smooth). Upright: z as near to up as it can be, as bodies that skid to turn.
enum class Stance { WithLift, Upright };

struct FlightTask {
  Launch launch;
  std::shared_ptr<const FlyingBody> body;
  std::optional<GuidanceOptions> guidance;  ///< needs a target
  PointMotion target;                       ///< empty: none
  double step_s = 0.005;                    ///< of integration, fixed: times of frames have no say
  double duration_s = 60.0;
  int keepEvery = 1;  ///< steps between points of the trajectory
  bool stopAtClosestApproach = true;
  double stopWithin_m = std::numeric_limits<double>::infinity();  ///< closest approaches farther away do not end the flight
  bool stopAtGround = true;
  Stance stance = Stance::WithLift;
  double roll_rad = 0.0, rollRate_rad_s = 0.0;  ///< on top of its stance: right wing down; since launch
  AtEnd before = AtEnd::Vanish, after = AtEnd::Vanish;
};

enum class FlightEnd { Duration, Ground, ClosestApproach };

struct FlightResult {
  Trajectory trajectory;
  FlightEnd end = FlightEnd::Duration;
  std::optional<ClosestApproach> closest;  ///< of the whole flight, where there is a target
};

/// Classical Runge-Kutta integration of order 4 with a fixed step, of position, velocity and lagged lateral acceleration; steps are cut where the body's
/// tables bend and where guidance begins, so that the order holds across them, and into 16 within four steps of passing the target, where the line of sight
/// turns fastest. Limits of lift and g are corners that cost order where they begin to act. Refused where step x rho v C_D A/m exceeds 2.7: unstable.
/// Ends are found within a step: ground and closest approach by the cubic through its ends, then integrated to that time.
/// Errors: FlightError (options, more than 10 million steps or a million points, a flight whose numbers overflow); std::invalid_argument without a body.
FlightResult fly(const FlightTask& task, const FlightWorld& world);

}  // namespace pitviper
