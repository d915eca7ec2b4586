#include "sensors/gimbal/gimbal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pitviper {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Times this near to an instant of the grid (0.5 ns) are the instant: at 1e6 s a double is good to 0.1 ns.
constexpr double kSame_s = 1e-6 * kServoStep_s;

struct Axis {
  double least, most, rate, acceleration, lag_s;
};
struct ServoCourse {
  double angle, rate;
};

/// Without a limit of acceleration: e' = s - clamp(e / T, +-rate) by pieces. It has one sign throughout, so there are three pieces at most.
ServoCourse lagged(const Axis& axis, double angle, double demand, double slope, double for_s) {
  const double end = demand + slope * for_s, T = axis.lag_s;
  if (T == 0.0 && axis.rate == kInfinite) return {end, slope};
  double e = demand - angle, left_s = for_s;
  if (axis.rate == kInfinite) {
    e = slope * T + (e - slope * T) * std::exp(-left_s / T);
    return {end - e, e / T};
  }
  const double bend = axis.rate * T;
  for (int piece = 0; piece < 3 && left_s > 0.0; ++piece) {
    const double sign = e > bend || (e == bend && slope > axis.rate) ? 1.0 : e < -bend || (e == -bend && slope < -axis.rate) ? -1.0 : 0.0;
    if (sign != 0.0) {
      const double closing = axis.rate - sign * slope, needed_s = (std::abs(e) - bend) / closing;
      if (closing <= 0.0 || needed_s >= left_s) {
        e += (slope - sign * axis.rate) * left_s;
        left_s = 0.0;
      } else {
        e = sign * bend;
        left_s -= needed_s;
      }
      continue;
    }
    if (T == 0.0) break;  // on the demand, and as fast
    const double final = slope * T;
    if (std::abs(slope) > axis.rate) {
      const double out = std::copysign(bend, slope), needed_s = T * std::log((final - e) / (final - out));
      if (needed_s < left_s) {
        e = out;
        left_s -= needed_s;
        continue;
      }
    }
    e = final + (e - final) * std::exp(-left_s / T);
    break;
  }
  const double rate = T > 0.0 ? std::clamp(e / T, -axis.rate, axis.rate) : e == 0.0 ? std::clamp(slope, -axis.rate, axis.rate) : std::copysign(axis.rate, e);
  return {end - e, rate};
}

/// w at the end of a step of h with w = f(q) there and q' = -w, w straight in it: f as documented with step().
double lawAtEnd(double q, double w, double acceleration, double lag_s, double h_s) {
  const double lead = q - 0.5 * w * h_s, straight = lead / (lag_s + 0.5 * h_s);
  if (std::abs(straight) <= acceleration * lag_s) return straight;
  const double half = 0.5 * acceleration * h_s;
  return std::copysign(std::sqrt(half * half + 2.0 * acceleration * (std::abs(lead) - 0.5 * acceleration * lag_s * lag_s)) - half, lead);
}

/// The rate at the end of a step with a limit of acceleration.
double rateAtEnd(const Axis& axis, double angle, double rate, double demand, double slope, double h_s) {
  const double lag_s = std::max(axis.lag_s, kServoStep_s);
  double wanted = slope + lawAtEnd(demand - angle - slope * axis.lag_s, rate - slope, axis.acceleration, lag_s, h_s);
  wanted = std::clamp(wanted, -axis.rate, axis.rate);
  // Slow enough to stop at the stops, as if they were demanded.
  if (axis.most < kInfinite) wanted = std::min(wanted, lawAtEnd(axis.most - angle, rate, axis.acceleration, kServoStep_s, h_s));
  if (axis.least > -kInfinite) wanted = std::max(wanted, lawAtEnd(axis.least - angle, rate, axis.acceleration, kServoStep_s, h_s));
  return std::clamp(wanted, rate - axis.acceleration * h_s, rate + axis.acceleration * h_s);
}

ServoCourse courseOf(const Axis& axis, double angle, double rate, double demand, double slope, double step_s, double for_s) {
  ServoCourse at;
  if (axis.acceleration == kInfinite) {
    at = lagged(axis, angle, demand, slope, for_s);
  } else {
    const double acceleration = (rateAtEnd(axis, angle, rate, demand, slope, step_s) - rate) / step_s;
    at = {angle + for_s * (rate + 0.5 * acceleration * for_s), rate + acceleration * for_s};
  }
  if (at.angle > axis.most) at = {axis.most, std::min(at.rate, 0.0)};
  if (at.angle < axis.least) at = {axis.least, std::max(at.rate, 0.0)};
  return at;
}

double orInfinite(double limit) { return limit > 0.0 ? limit : kInfinite; }

Axis axisOf(const GimbalOptions& o, int i) {
  const GimbalLimits& l = o.limits;
  return {i == 0 ? -l.azimuth_rad : l.elevation_rad.x, i == 0 ? l.azimuth_rad : l.elevation_rad.y, orInfinite(l.rate_rad_s), orInfinite(l.acceleration_rad_s2),
          o.lag_s};
}

double gridAfter_s(double time_s) { return (std::floor((time_s + kSame_s) / kServoStep_s) + 1.0) * kServoStep_s; }

glm::dvec2 demandAt(const GimbalOptions& options, const GimbalDemand& demanded, double time_s, double nearAzimuth) {
  glm::dvec2 d = demanded(time_s);
  if (!std::isfinite(d.x) || !std::isfinite(d.y)) throw std::invalid_argument("gimbal: a demand that is no number");
  d.x = azimuthNear(options.limits, d.x, nearAzimuth);
  return withinLimits(options.limits, d);
}

/// The demand from the servo's instant on, straight to the next.
void decide(const GimbalOptions& options, const GimbalDemand& demanded, GimbalState::Servo& servo) {
  const double next_s = gridAfter_s(servo.since_s);
  servo.decided = true;
  servo.demand_rad = demandAt(options, demanded, servo.since_s, servo.angle_rad.x);
  servo.demandRate_rad_s = (demandAt(options, demanded, next_s, servo.demand_rad.x) - servo.demand_rad) / (next_s - servo.since_s);
}

void advance(const GimbalOptions& options, const GimbalState::Servo& servo, double for_s, glm::dvec2& angle, glm::dvec2& rate) {
  const double step_s = gridAfter_s(servo.since_s) - servo.since_s;
  for (int i = 0; i < 2; ++i) {
    const ServoCourse at = courseOf(axisOf(options, i), servo.angle_rad[i], servo.rate_rad_s[i], servo.demand_rad[i], servo.demandRate_rad_s[i], step_s, for_s);
    angle[i] = at.angle;
    rate[i] = at.rate;
  }
}

}  // namespace

bool followsAtOnce(const GimbalOptions& o) { return o.lag_s == 0.0 && !(o.limits.rate_rad_s > 0.0) && !(o.limits.acceleration_rad_s2 > 0.0); }

void requireSound(const GimbalOptions& o) {
  const auto require = [](bool sound, const char* what) {
    if (!sound) throw std::invalid_argument(std::string("gimbal: ") + what);
  };
  const GimbalLimits& l = o.limits;
  const auto isSize = [](double v) { return v >= 0.0 && std::isfinite(v); };
  const auto isVector = [](const glm::dvec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); };
  require(l.azimuth_rad >= 0.0, "an azimuth limit that is negative or no number");
  require(l.elevation_rad.x <= l.elevation_rad.y && l.elevation_rad.x >= -1.5707963267948967 && l.elevation_rad.y <= 1.5707963267948967,
          "elevation limits that hold nothing or pass the vertical");
  require(isSize(l.rate_rad_s) && isSize(l.acceleration_rad_s2), "a limit of rate or acceleration that is negative or no number");
  require(isSize(o.lag_s), "a lag that is negative or no number");
  require(isVector(o.boresight_rad) && isVector(o.offset_rad) && std::isfinite(o.roll_rad), "an error, offset or roll that is no number");
  requireSound(o.jitter.left);
  requireSound(o.jitter.up);
  requireSound(o.scan);
}

GimbalState step(const GimbalOptions& options, const GimbalState& state, const GimbalDemand& demanded, double until_s) {
  if (!(until_s >= state.time_s) || !std::isfinite(until_s)) throw std::invalid_argument("gimbal: a time that goes back");
  GimbalState s = state;
  s.time_s = until_s;
  if (followsAtOnce(options)) {
    s.angle_rad = demandAt(options, demanded, until_s, state.angle_rad.x);
    s.rate_rad_s = (s.angle_rad - demandAt(options, demanded, until_s - kServoStep_s, s.angle_rad.x)) / kServoStep_s;
    s.servo = {};
    return s;
  }
  GimbalState::Servo& servo = s.servo;
  if (!servo.decided) servo = {true, state.time_s, state.angle_rad, state.rate_rad_s, {}, {}};
  if (state.time_s - servo.since_s <= kSame_s) decide(options, demanded, servo);
  for (;;) {
    const double next_s = gridAfter_s(servo.since_s);
    if (until_s < next_s - kSame_s) break;
    glm::dvec2 angle, rate;
    advance(options, servo, next_s - servo.since_s, angle, rate);
    servo.since_s = next_s;
    servo.angle_rad = angle;
    servo.rate_rad_s = rate;
    if (until_s - next_s <= kSame_s) {  // the next call's demand holds from here
      s.angle_rad = angle;
      s.rate_rad_s = rate;
      return s;
    }
    decide(options, demanded, servo);
  }
  advance(options, servo, until_s - servo.since_s, s.angle_rad, s.rate_rad_s);
  return s;
}

GimbalState step(const GimbalOptions& options, const GimbalState& state, glm::dvec2 demanded_rad, double until_s) {
  return step(
      options, state, [&](double) { return demanded_rad; }, until_s);
}

}  // namespace pitviper
