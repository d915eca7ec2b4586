// A gimbal against closed forms of its loop and its limits; directions as it has them.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "sensors/gimbal/follow_loop.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/gimbal_pictures.hpp"

namespace pitviper::test {
namespace {

GimbalState turning(const GimbalOptions& o, double demand, double until_s) { return step(o, {}, glm::dvec2(demand, 0.0), until_s); }

TEST(GimbalStep, LagAnswersAStepByAnExponential) {
  GimbalOptions o;
  o.lag_s = 0.05;
  double worst = 0.0;
  for (const double t_s : {0.0003, 0.01, 0.05, 0.2137, 1.0})
    worst = std::max(worst, std::abs(turning(o, 0.4, t_s).angle_rad.x - 0.4 * -std::expm1(-t_s / 0.05)));
  bound("gimbal: step through a lag of 50 ms, error [rad]", worst, kRounding, "0.4 (1 - exp(-t / T)); each step is exact, rounding is left");
  // With a limit of acceleration the rate takes one servo step to rise: half a step behind.
  o.limits.acceleration_rad_s2 = 1e6;
  double late = 0.0;
  for (const double t_s : {0.01, 0.05, 0.2}) late = std::max(late, std::abs(turning(o, 0.4, t_s).angle_rad.x - 0.4 * -std::expm1(-t_s / 0.05)));
  bound("gimbal: the same with 1e6 rad/s2, error [rad]", late, 0.4 * 0.5 * kServoStep_s / 0.05, "the exponential, half a servo step late at most");
}

TEST(GimbalStep, RampIsFollowedOneLagBehind) {
  for (const double acceleration : {0.0, 20.0})
    for (const double lag_s : {0.0, 0.0002, 0.08}) {
      GimbalOptions o;
      o.lag_s = lag_s;
      o.limits.acceleration_rad_s2 = acceleration;
      const double rate = 0.3, until_s = 2.71;
      const GimbalState s = step(
          o, {}, [&](double t) { return glm::dvec2(rate * t, 0.0); }, until_s);
      // 34 lags: exp(-34) = 2e-15 of the start is left.
      EXPECT_NEAR(rate * until_s - s.angle_rad.x, rate * lag_s, kRounding) << acceleration << " " << lag_s;
      EXPECT_NEAR(s.rate_rad_s.x, rate, 1e-9) << acceleration << " " << lag_s;  // a difference of angles over a step: 1e-12 / 5e-4
    }
}

TEST(GimbalStep, SinePassesTheLagAsTheTransferFunctionSays) {
  GimbalOptions o;
  o.lag_s = 0.02;
  const double omega = 2.0 * kPi * 5.0, until_s = 1.0;
  const GimbalState s = step(
      o, {}, [&](double t) { return glm::dvec2(0.1 * std::sin(omega * t), 0.0); }, until_s);
  const std::complex<double> transfer = 1.0 / std::complex<double>(1.0, omega * o.lag_s);
  const double expected = 0.1 * std::abs(transfer) * std::sin(omega * until_s + std::arg(transfer));
  // Straight pieces of a sine have (omega h)^2 / 12 less of it: 2e-5 of 0.1; the start has gone by exp(-50).
  bound("gimbal: 5 Hz through a lag of 20 ms, error [rad]", std::abs(s.angle_rad.x - expected), 0.1 * std::pow(omega * kServoStep_s, 2) / 12.0 * 1.05,
        "0.1 |1 / (1 + i w T)| with its phase; straight pieces of (w h)^2 / 12");
}

TEST(GimbalStep, RateLimitMakesTheSlewTime) {
  GimbalOptions o;
  o.limits.rate_rad_s = 0.5;
  EXPECT_NEAR(turning(o, 1.0, 0.7).angle_rad.x, 0.35, kRounding);
  EXPECT_NEAR(turning(o, 1.0, 1.9999).angle_rad.x, 0.99995, kRounding);
  EXPECT_EQ(turning(o, 1.0, 2.0 + 1e-9).angle_rad.x, 1.0);
  // With a lag: at the rate until e = rate T, then exponentially.
  o.lag_s = 0.2;
  const double bend_s = (1.0 - 0.5 * 0.2) / 0.5;
  EXPECT_NEAR(turning(o, 1.0, bend_s + 0.3).angle_rad.x, 1.0 - 0.1 * std::exp(-1.5), kRounding);
  // A demand that runs away faster than the limit is lost at the difference.
  const GimbalState s = step(
      o, {}, [](double t) { return glm::dvec2(0.8 * t, 0.0); }, 3.0);
  EXPECT_NEAR(s.rate_rad_s.x, 0.5, kRounding);
  // e = 0.8 T (1 - exp(-t/T)) reaches 0.5 T at t1 = T ln(8/3); from there the angle is straight.
  const double leaves_s = 0.2 * std::log(0.8 / 0.3), there = 0.8 * leaves_s - 0.1;
  EXPECT_NEAR(s.angle_rad.x, there + 0.5 * (3.0 - leaves_s), kRounding);
}

/// When the rest is below a bound for good.
double arrival_s(const GimbalOptions& o, double demand, double rest, double most_s) {
  double last_s = 0.0;
  GimbalState s;
  for (double t = 1e-4; t < most_s; t += 1e-4) {
    s = step(o, s, glm::dvec2(demand, 0.0), t);
    if (std::abs(demand - s.angle_rad.x) > rest) last_s = t;
  }
  return last_s;
}

TEST(GimbalStep, AccelerationLimitMakesTheSlewTime) {
  GimbalOptions o;
  o.limits.rate_rad_s = 0.5;
  o.limits.acceleration_rad_s2 = 2.0;
  // The last A h^2 goes through the least lag, one servo step: the time is met to some steps, and to what braking needs for the rest, sqrt(2 rest / A).
  const double rest = 2.0 * 2.0 * kServoStep_s * kServoStep_s;
  figure("gimbal: slew of 1 rad at 0.5 rad/s and 2 rad/s2 [s]", arrival_s(o, 1.0, rest, 3.0), 1.0 / 0.5 + 0.5 / 2.0, 5.0 * kServoStep_s / 2.25,
         "d / v + v / A; five servo steps");
  figure("gimbal: slew of 0.1 rad, which does not reach 0.5 rad/s [s]", arrival_s(o, 0.1, rest, 1.0), 2.0 * std::sqrt(0.1 / 2.0), 5.0 * kServoStep_s / 0.447,
         "2 sqrt(d / A); five servo steps");
  EXPECT_NEAR(turning(o, 1.0, 0.2).angle_rad.x, 0.5 * 2.0 * 0.04, kRounding);
  EXPECT_NEAR(turning(o, 1.0, 1.0).angle_rad.x, 0.5 * 0.25 * 0.5 + 0.5 * 0.75, kRounding);
}

TEST(GimbalStep, WhatMovesTooFastPassesByWhatStoppingTakes) {
  GimbalOptions o;
  o.limits.acceleration_rad_s2 = 2.0;
  GimbalState s;
  s.rate_rad_s.x = 0.6;
  double most = 0.0;
  for (int i = 1; i <= 1000; ++i) s = step(o, s, glm::dvec2(0.0), i * 1e-3), most = std::max(most, s.angle_rad.x);
  // Brakes at once: the law, met at the end of a step, asks for less than any step can do.
  figure("gimbal: overshoot of 0.6 rad/s at 2 rad/s2 [rad]", most, 0.6 * 0.6 / 4.0, 1e-4, "v^2 / (2 A); the highest of what was asked, each 1 ms");
  EXPECT_NEAR(s.angle_rad.x, 0.0, 1e-9);  // long since back: exp(-1 s / one servo step) is nothing
}

GimbalOptions optionsOf(Randomly& random) {
  GimbalOptions o;
  o.limits.azimuth_rad = random(0.1, 2.0);
  o.limits.elevation_rad = {-random(0.1, 1.0), random(0.1, 1.0)};
  o.limits.rate_rad_s = random(0.0, 1.0) < 0.3 ? 0.0 : random(0.2, 5.0);
  o.limits.acceleration_rad_s2 = random(0.0, 1.0) < 0.3 ? 0.0 : random(1.0, 300.0);
  o.lag_s = random(0.0, 1.0) < 0.3 ? 0.0 : std::pow(10.0, random(-4.5, -0.5));
  return o;
}

TEST(GimbalStep, NeverLeavesItsLimits) {
  Randomly random;
  for (int run = 0; run < 150; ++run) {
    const GimbalOptions o = optionsOf(random);
    GimbalState s;
    for (int i = 0; i < 120; ++i) {
      const glm::dvec2 demand(random(-4.0, 4.0), random(-1.5, 1.5)),
          slope = random(0.0, 1.0) < 0.5 ? glm::dvec2(0.0) : glm::dvec2(random(-9.0, 9.0), random(-9.0, 9.0));
      const double begin_s = s.time_s, end_s = begin_s + random(0.0, 0.08);
      while (s.time_s < end_s) {
        const GimbalState before = s;
        s = step(
            o, s, [&](double t) { return demand + slope * (t - begin_s); }, std::min(end_s, s.time_s + random(1e-5, 2e-3)));
        EXPECT_LE(std::abs(s.angle_rad.x), o.limits.azimuth_rad);
        EXPECT_GE(s.angle_rad.y, o.limits.elevation_rad.x);
        EXPECT_LE(s.angle_rad.y, o.limits.elevation_rad.y);
        for (int axis = 0; axis < 2; ++axis) {
          // Times within 0.5 ns of the servo's grid are its instants.
          if (o.limits.rate_rad_s > 0.0) {
            EXPECT_LE(std::abs(s.rate_rad_s[axis]), o.limits.rate_rad_s + kRounding);
            EXPECT_LE(std::abs(s.angle_rad[axis] - before.angle_rad[axis]), o.limits.rate_rad_s * (s.time_s - before.time_s + 1e-9) + kRounding);
          }
          if (o.limits.acceleration_rad_s2 > 0.0) {
            EXPECT_LE(std::abs(s.rate_rad_s[axis] - before.rate_rad_s[axis]), o.limits.acceleration_rad_s2 * (s.time_s - before.time_s + 1e-9) + kRounding);
          }
        }
        if (HasFailure()) FAIL() << "run " << run << " at " << s.time_s << " s";
      }
    }
  }
}

TEST(GimbalStep, DoesNotOvershootFromRest) {
  Randomly random;
  double most = 0.0, rest = 0.0;
  for (int run = 0; run < 150; ++run) {
    const GimbalOptions o = optionsOf(random);
    const double demand = random(-1.0, 1.0) * o.limits.azimuth_rad;  // up to its stops
    GimbalState s;
    for (int i = 1; i <= 2000; ++i) {
      s = step(o, s, glm::dvec2(demand, 0.0), i * 1.7e-3);
      most = std::max(most, (s.angle_rad.x - demand) * (demand > 0.0 ? 1.0 : -1.0));
    }
    const double slowest_s = 20.0 * o.lag_s + 2.0 / 0.2 + 2.0;
    s = step(o, s, glm::dvec2(demand, 0.0), s.time_s + slowest_s);
    rest = std::max(rest, std::abs(s.angle_rad.x - demand));
  }
  bound("gimbal: overshoot from rest, 150 random gimbals [rad]", most, kRounding, "0: rounding");
  bound("gimbal: what is left after 20 lags and the slew [rad]", rest, 2.0 * std::exp(-20.0) + kRounding, "exp(-20) of the way");
}

TEST(GimbalStep, DoesNotDependOnHowTimeIsCut) {
  Randomly random;
  for (int run = 0; run < 60; ++run) {
    const GimbalOptions o = optionsOf(random);
    const auto demanded = [](double t) { return glm::dvec2(1.5 * std::sin(7.0 * t), std::cos(11.0 * t)); };
    const glm::dvec2 stands(random(-1.0, 1.0), random(-1.0, 1.0));
    GimbalState start, whole, cut, wholeStands, cutStands;
    start.time_s = random(0.0, 1.0) < 0.5 ? 0.0 : random(0.0, 3600.0);
    whole = cut = wholeStands = cutStands = start;
    const double until_s = start.time_s + 0.731;
    whole = step(o, whole, demanded, until_s);
    wholeStands = step(o, wholeStands, stands, until_s);
    while (cut.time_s < until_s) {
      const double next_s = std::min(until_s, random(0.0, 1.0) < 0.2 ? std::ceil(cut.time_s * 2000.0 + 1e-3) / 2000.0 : cut.time_s + random(0.0, 5e-3));
      cut = step(o, cut, demanded, next_s);
      cutStands = step(o, cutStands, stands, next_s);
    }
    EXPECT_EQ(whole.angle_rad, cut.angle_rad) << run;
    EXPECT_EQ(whole.rate_rad_s, cut.rate_rad_s) << run;
    EXPECT_EQ(wholeStands.angle_rad, cutStands.angle_rad) << run;
    EXPECT_EQ(wholeStands.rate_rad_s, cutStands.rate_rad_s) << run;
  }
}

TEST(GimbalStep, TurnsTheShortWayWhereItsLimitsLetIt) {
  GimbalOptions o;
  o.limits.rate_rad_s = 1.0;
  GimbalState s;
  s.angle_rad.x = 170.0 * kDegree;
  EXPECT_NEAR(step(o, s, {-170.0 * kDegree, 0.0}, 10.0).angle_rad.x, 190.0 * kDegree, kRounding);
  o.limits.azimuth_rad = 175.0 * kDegree;
  EXPECT_NEAR(step(o, s, {-170.0 * kDegree, 0.0}, 10.0).angle_rad.x, -170.0 * kDegree, kRounding);
  o.limits.azimuth_rad = 60.0 * kDegree;
  EXPECT_NEAR(step(o, {}, {100.0 * kDegree, 1.0}, 10.0).angle_rad.x, 60.0 * kDegree, kRounding);
}

TEST(GimbalStep, WithoutLimitsAndLagItIsWhereItIsDemanded) {
  const GimbalOptions o;
  const GimbalState s = step(
      o, {}, [](double t) { return glm::dvec2(0.3 * t, 0.1); }, 0.00123);
  EXPECT_EQ(s.angle_rad, glm::dvec2(0.3 * 0.00123, 0.1));
  EXPECT_NEAR(s.rate_rad_s.x, 0.3, kRounding);
}

TEST(GimbalStep, RefusesWhatIsNoGimbal) {
  GimbalState s;
  s.time_s = 1.0;
  EXPECT_THROW(step(GimbalOptions{}, s, glm::dvec2(0.0), 0.5), std::invalid_argument);
  EXPECT_THROW(step(GimbalOptions{}, s, glm::dvec2(std::nan(""), 0.0), 1.5), std::invalid_argument);
  GimbalOptions o;
  EXPECT_NO_THROW(requireSound(o));
  o.limits.elevation_rad = {0.2, 0.1};
  EXPECT_THROW(requireSound(o), std::invalid_argument);
  o = {};
  o.lag_s = -1.0;
  EXPECT_THROW(requireSound(o), std::invalid_argument);
}

TEST(Pointing, AnglesAreLeftAndUpInTheCarriersAxes) {
  Pose carrier{{100.0, 200.0, 300.0}, orientationFrom({0.0, 0.0, 0.0})};  // heading north: x north, y west
  const glm::dvec3 camera = carrier.position;
  const auto northWest = demandOf(carrier, camera, camera + glm::dvec3(-10, 10, 0)), up = demandOf(carrier, camera, camera + glm::dvec3(0, 10, 10));
  ASSERT_TRUE(northWest && up);
  EXPECT_NEAR(northWest->x, 45.0 * kDegree, kRounding);
  EXPECT_NEAR(northWest->y, 0.0, kRounding);
  EXPECT_NEAR(up->x, 0.0, kRounding);
  EXPECT_NEAR(up->y, 45.0 * kDegree, kRounding);
  EXPECT_FALSE(demandOf(carrier, camera, camera));
  // Right side down.
  EXPECT_NEAR((orientationOf({0.0, 0.0}, 0.2) * glm::dvec3(0, 1, 0)).z, std::sin(0.2), kRounding);
  Randomly random;
  for (int i = 0; i < 100; ++i) {
    carrier.orientation = orientationFrom({random(0.0, 6.0), random(-1.5, 1.5), random(-3.0, 3.0)});
    const glm::dvec3 target(random(-1e4, 1e4), random(-1e4, 1e4), random(-1e4, 1e4));
    const glm::dvec2 angles = *demandOf(carrier, camera, target);
    const glm::dvec3 sight = carrier.orientation * orientationOf(angles, random(-3.0, 3.0)) * glm::dvec3(1, 0, 0);
    EXPECT_LT(glm::length(sight - glm::normalize(target - camera)), kRounding);
    const glm::dvec2 offset(random(-0.1, 0.1), random(-0.1, 0.1));
    EXPECT_NEAR(std::acos(glm::dot(directionOf(turned(angles, offset)), directionOf(angles))), std::acos(std::cos(offset.x) * std::cos(offset.y)), 1e-9);
  }
}

TEST(Pointing, SaysHowFarBeyondItsLimitsATargetLies) {
  GimbalLimits limits;
  limits.azimuth_rad = 60.0 * kDegree;
  limits.elevation_rad = {-10.0 * kDegree, 70.0 * kDegree};
  EXPECT_EQ(beyondLimits(limits, {0.5, -0.1}), glm::dvec2(0.0));
  const glm::dvec2 beyond = beyondLimits(limits, {-72.5 * kDegree, 75.0 * kDegree});
  EXPECT_NEAR(beyond.x, -12.5 * kDegree, kRounding);
  EXPECT_NEAR(beyond.y, 5.0 * kDegree, kRounding);
  EXPECT_NO_THROW(requireWithinLimits(limits, {0.5, -0.1}, "seeker", {"duel.yaml", 12, 5, -1}));
  try {
    requireWithinLimits(limits, {-72.5 * kDegree, 75.0 * kDegree}, "seeker", {"duel.yaml", 12, 5, -1});
    FAIL();
  } catch (const UserError& e) {
    EXPECT_STREQ(
        e.what(),
        "duel.yaml:12:5: camera 'seeker': its gimbal cannot see its target at the start: 12.5 deg beyond its limit in azimuth, to the right (it lies at "
        "-72.5 deg) and 5 deg beyond its limit in elevation, to the top (it lies at 75 deg); expected azimuth from -60 deg to 60 deg, elevation from "
        "-10 deg to 70 deg; fix: turn the carrier toward the target, or widen the limits");
  }
}

TEST(Pointing, FilmAndDirectionAreOneAnothersInverse) {
  const Pinhole p = film();
  EXPECT_LT(directionOfFilm(p, {40.0, 24.0}).y, 0.0);  // right of the middle
  EXPECT_GT(directionOfFilm(p, {32.0, 10.0}).z, 0.0);  // above it
  const auto back = filmOf(p, 7.0 * directionOfFilm(p, {3.25, 41.5}));
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->x, 3.25, 1e-10);  // 1e-16 of tangents times 5000 pixels
  EXPECT_NEAR(back->y, 41.5, 1e-10);
  EXPECT_FALSE(filmOf(p, {-1.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace pitviper::test
