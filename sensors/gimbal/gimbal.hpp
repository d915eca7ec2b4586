#pragma once
// A gimbal of two axes that follows a demanded direction: a loop with a first-order lag, limits of angle, rate and acceleration. Angles and axes: pointing.hpp.
#include <functional>
#include <glm/glm.hpp>

#include "sensors/gimbal/jitter.hpp"
#include "sensors/gimbal/pointing.hpp"
#include "sensors/gimbal/scan.hpp"

namespace pitviper {

struct GimbalOptions {
  GimbalLimits limits;
  double lag_s = 0.0;             ///< T of the loop: the rate is (demanded - angle) / T within the limits; 0: none
  glm::dvec2 boresight_rad{0.0};  ///< fixed error: the line of sight lies this (left, up) from where the gimbal's angles say
  glm::dvec2 offset_rad{0.0};     ///< the gimbal is to aim this (left, up) beside the line to the target
  double roll_rad = 0.0;          ///< of the camera about its line of sight
  bool stabilised = true;         ///< between demands it holds a line in space; else its angles to the carrier
  Jitter jitter;                  ///< none
  Scan scan;                      ///< none
};

/// Errors: std::invalid_argument for limits that hold nothing, negative rates, accelerations or lags, what is no number, and unsound jitter or scan.
void requireSound(const GimbalOptions& options);

/// Without lag and limits of rate and acceleration it is where it is demanded to be, whatever the time before.
bool followsAtOnce(const GimbalOptions& options);

/// Between instants of this grid (2000 a second) the servo goes on as it decided at the last one.
constexpr double kServoStep_s = 1.0 / 2000.0;

struct GimbalState {
  double time_s = 0.0;
  glm::dvec2 angle_rad{0.0};  ///< azimuth, elevation; azimuth counts on beyond a turn where it has no limit
  glm::dvec2 rate_rad_s{0.0};

  /// What the servo decided, for step() alone: where it stood at the last instant of its grid and what is demanded from there on.
  struct Servo {
    bool decided = false;
    double since_s = 0.0;
    glm::dvec2 angle_rad{0.0}, rate_rad_s{0.0}, demand_rad{0.0}, demandRate_rad_s{0.0};
  } servo;
};

/// Azimuth and elevation over time; a function of time alone.
using GimbalDemand = std::function<glm::dvec2(double time_s)>;

/// The state at `until_s`, with demands beyond the limits taken at the limits and azimuths the short way where the limits let them.
///
/// Law by axis, e = demanded - angle, s the demand's own rate, A the acceleration: without A the rate is e / T within the rate limit, solved exactly in each
/// step for a demand that is straight in it. With A the rate is to be s + f(e - s T), f(q) = q / T up to |q| = A T^2, beyond it sign(q) sqrt(2 A (|q| - A T^2 /
/// 2)), which meets it without a bend: the proximate time-optimal servomechanism. Source: M. L. Workman,
/// "Adaptive proximate time-optimal servomechanisms", thesis, Stanford University 1987, without its discount of A. f takes at least one servo step for T; a
/// ramp is followed s T behind all the same. Discretisation: rates are straight within a step, the law is met at its end (trapezoidal rule: second order in the
/// step; braking along the root is exact). Overshoot: from rest none of a demand that stands; a gimbal that moves too fast to stop in time passes it by what
/// stopping takes. Limits: never exceeded by one that starts within them, slow enough to stop there; another is stopped hard at its stop. The servo takes
/// demands at instants of its grid (one without limits and lag at once), so that the state does not depend on how the time was cut, to the bit. Demands of a
/// function are read a step ahead. Errors: std::invalid_argument for times that go back and demands that are no numbers.
GimbalState step(const GimbalOptions& options, const GimbalState& state, const GimbalDemand& demanded, double until_s);
/// The same for a demand that stands.
GimbalState step(const GimbalOptions& options, const GimbalState& state, glm::dvec2 demanded_rad, double until_s);

}  // namespace pitviper
