#pragma once
// Textbook guidance: enough that a missile of a scenario flies at its target. What a seeker sees and how it filters is not in it.
#include <limits>

#include "sim/flight/moving_point.hpp"

namespace pitviper {

/// TrueProportional: a = N' V_c (w x r^), across the line of sight, flown as a whole: its part along the velocity changes the speed, as in the published
/// engagement; PureProportional: a = N' w x v, across the velocity; w = r x v_rel / r^2 turns the line of
/// sight, V_c is the closing speed (0 where the target opens). Source: Zarchan, Tactical and Strategic Missile Guidance, ch. 2 (law, and the listing of its
/// two-dimensional engagement); Shneydor, Missile Guidance and Pursuit, ch. 5. Pursuit: velocity turns with the line of sight and towards it, a = w x v + K V
/// (r^ - (r^ v^) v^): Shneydor, ch. 3, with a gain for the error.
enum class GuidanceLaw { TrueProportional, PureProportional, Pursuit };

struct GuidanceOptions {
  GuidanceLaw law = GuidanceLaw::TrueProportional;
  double navigationConstant = 4.0;                          ///< N', 1 to 10; 3 to 5 are usual
  double pursuitGain_per_s = 2.0;                           ///< K, 0 or more
  double begin_s = 0.0;                                     ///< since launch; nothing is commanded before
  bool gravityCompensation = true;                          ///< adds what carries the body's weight across its velocity
  double timeConstant_s = 0.0;                              ///< first-order lag of what is flown behind what is commanded; 0 none, else not below the step
  double most_g = std::numeric_limits<double>::infinity();  ///< of the command, in units of 9.80665 m/s2
  /// Nearer than this only weight is compensated: a seeker's picture fills its field, and the line of sight turns without bound. Greater than 0.
  double blindRange_m = 5.0;
};

/// What the law commands [m/s2], weight and limit included, lag not.
glm::dvec3 guidanceCommand(const GuidanceOptions& options, const MovingPoint& own, const MovingPoint& target, const glm::dvec3& gravity_m_s2);

/// Errors: FlightError naming the option.
void checkGuidance(const GuidanceOptions& options);

}  // namespace pitviper
