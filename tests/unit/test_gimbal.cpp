// The camera that follows: the gimbal against closed forms of its loop, scans and jitter against theirs, the plain tracker on drawn spots, and the loop of all.
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

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kRounding = 1e-12;  // of some thousand additions in double near 1

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

struct Randomly {
  std::mt19937_64 engine{20240715};
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
};

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

Pinhole film() {
  Pinhole p;
  p.width = 64;
  p.height = 48;
  p.focalLength_m = 0.1;
  p.pitchX_m = 20e-6;
  p.pitchY_m = 25e-6;
  return p;
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

TEST(GimbalScan, RasterGoesThroughItsLinesEvenly) {
  Scan s;
  s.kind = Scan::Kind::Raster;
  s.width_rad = 0.2, s.height_rad = 0.12, s.lines = 6, s.lineRate_Hz = 100.0, s.flyback = 0.25;
  EXPECT_NEAR(*scanPeriod_s(s), 0.06, kRounding);
  std::set<long> heights;
  for (int line = 0; line < 6; ++line) {
    const double begin_s = line * 0.01;
    const auto at = [&](double share) { return scanAt(s, begin_s + share * 0.01); };
    heights.insert(std::lround(at(0.3).y * 1e6));
    // Left to right at width / active time, constant.
    EXPECT_NEAR(at(0.1).x, 0.1 - 0.2 * 0.1 / 0.75, 1e-12);
    EXPECT_NEAR((at(0.7).x - at(0.2).x) / 0.005, -0.2 / 0.0075, 1e-9);
    EXPECT_EQ(at(0.05).y, at(0.74).y);
    EXPECT_NEAR(at(0.875).x, 0.0, 1e-12);  // half way back
  }
  // Middles of six bands that cover the field: no gap, no overlap.
  EXPECT_EQ(heights, (std::set<long>{-50000, -30000, -10000, 10000, 30000, 50000}));
  EXPECT_NEAR(scanAt(s, 0.0599999).y, 0.05, 1e-5);                                     // on the way back to the first line, 1e-4 of the flyback's height away
  EXPECT_NEAR(glm::length(scanAt(s, 0.0137) - scanAt(s, 0.0137 + 600.0)), 0.0, 1e-9);  // 600 s rounded 1e-13, at 27 rad/s
}

TEST(GimbalScan, SpiralHasEvenTurns) {
  Scan s;
  s.kind = Scan::Kind::Spiral;
  s.radius_rad = 0.05, s.turns = 4.0, s.frequency_Hz = 10.0;
  EXPECT_NEAR(*scanPeriod_s(s), 0.8, kRounding);
  for (double t = 0.0; t < 0.4; t += 0.013) EXPECT_NEAR(glm::length(scanAt(s, t)), 0.05 * t / 0.4, kRounding);
  for (double t = 0.05; t < 0.29; t += 0.013)
    EXPECT_NEAR(glm::length(scanAt(s, t + 0.1)) - glm::length(scanAt(s, t)), 0.05 / 4.0, kRounding);                  // one pitch a turn
  for (double t = 0.0; t < 0.4; t += 0.013) EXPECT_NEAR(glm::length(scanAt(s, 0.8 - t) - scanAt(s, t)), 0.0, 1e-12);  // and back as it came
}

TEST(GimbalScan, ConeIsACircle) {
  Scan s;
  s.kind = Scan::Kind::Conical;
  s.radius_rad = 0.02, s.frequency_Hz = 70.0, s.phase_rad = 0.5;
  EXPECT_NEAR(scanAt(s, 0.0).x, 0.02 * std::cos(0.5), kRounding);
  EXPECT_NEAR(scanAt(s, 0.25 / 70.0).y, 0.02 * std::sin(0.5 + 0.5 * kPi), kRounding);
  for (double t = 0.0; t < 0.1; t += 0.0017) {
    EXPECT_NEAR(glm::length(scanAt(s, t)), 0.02, kRounding);
    EXPECT_NEAR(glm::length(scanAt(s, t + 1.0 / 70.0) - scanAt(s, t)), 0.0, kRounding);
  }
}

int countPetals(const Scan& s) {
  // Tips: where the radius is at a maximum. A hundred samples from tip to tip or more.
  const double period_s = *scanPeriod_s(s);
  constexpr int kSamples = 40000;
  std::vector<double> radius;
  for (int i = 0; i < kSamples; ++i) radius.push_back(glm::length(scanAt(s, period_s * (i + 0.5) / kSamples)));
  int tips = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double before = radius[static_cast<size_t>((i + kSamples - 1) % kSamples)], after = radius[static_cast<size_t>((i + 1) % kSamples)];
    if (radius[static_cast<size_t>(i)] > before && radius[static_cast<size_t>(i)] >= after) ++tips;
  }
  return tips;
}

TEST(GimbalScan, RosetteHasItsPetals) {
  Scan s;
  s.kind = Scan::Kind::Rosette;
  s.radius_rad = 0.018;
  struct Case {
    double f1, f2;
    int petals;
  };
  for (const auto& [f1, f2, petals] : {Case{200.0, 80.0, 7}, Case{13.0, 7.0, 20}, Case{100.0, 77.0, 177}, Case{2.1, 1.5, 12}, Case{50.0, 50.0, 2}}) {
    s.frequency_Hz = f1, s.secondFrequency_Hz = f2;
    ASSERT_TRUE(scanPeriod_s(s));
    EXPECT_EQ(rosettePetals(f1, f2), petals);
    EXPECT_EQ(countPetals(s), petals) << f1 << " " << f2;
    const double period_s = *scanPeriod_s(s);
    EXPECT_NEAR(glm::length(scanAt(s, 0.37 * period_s) - scanAt(s, 3.37 * period_s)), 0.0, 1e-12);
    for (int i = 0; i < 50; ++i) {
      const double t = period_s * i / 50.0;
      EXPECT_NEAR(glm::length(scanAt(s, t)), 0.018 * std::abs(std::cos(kPi * (f1 + f2) * t)), 1e-12);
    }
  }
  EXPECT_FALSE(rosettePetals(100.0, 100.0 / std::sqrt(2.0)));
  s.frequency_Hz = 0.0;
  EXPECT_THROW(requireSound(s), std::invalid_argument);
}

AxisJitter table() {
  AxisJitter j;
  j.spectrum = {{1.0, 4e-10}, {5.0, 4e-10}, {20.0, 5e-11}, {30.0, 3e-10}, {35.0, 2e-11}, {150.0, 1e-12}};
  return j;
}

/// Trapezoids of the table, written out.
constexpr double kTableVariance = 4.0 * 4e-10 + 15.0 * 0.5 * 4.5e-10 + 10.0 * 0.5 * 3.5e-10 + 5.0 * 0.5 * 3.2e-10 + 115.0 * 0.5 * 2.1e-11;

TEST(GimbalJitter, VarianceIsTheIntegralOfTheSpectrum) {
  figure("jitter: variance of a table [rad2]", variance_rad2(table()), kTableVariance, 1e-14, "sum of trapezoids");
  AxisJitter markov;
  markov.rms_rad = 5e-5, markov.corner_Hz = 3.0;
  const JitterCourse course({table(), markov}, 7, "seeker");
  const double span_s = 80.0, rate_Hz = 400.0;
  const int count = static_cast<int>(span_s * rate_Hz);
  glm::dvec2 mean(0.0), square(0.0);
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 v = course.at(i / rate_Hz);
    mean += v / static_cast<double>(count), square += v * v / static_cast<double>(count);
  }
  // The estimate's deviation is sqrt(integral of S^2 / span) of it (J. S. Bendat and A. G. Piersol, Random Data, section 8.2.2): for the table the density is
  // below 4e-10, so that integral S^2 < 4e-10 variance; for the Markov process integral S^2 = rms^4 / (pi fc). Four deviations.
  figure("jitter: mean square of a table over 80 s [rad2]", square.x, kTableVariance, 4.0 * std::sqrt(4e-10 / kTableVariance / span_s),
         "integral of the spectrum; four deviations of the estimate");
  figure("jitter: mean square of 50 urad with a corner of 3 Hz [rad2]", square.y, 25e-10, 4.0 / std::sqrt(kPi * 3.0 * span_s),
         "rms^2; four deviations of the estimate");
  // Means: S(0) / (2 span).
  EXPECT_LT(std::abs(mean.x), 4.0 * std::sqrt(4e-10 / 2.0 / span_s));
  EXPECT_LT(std::abs(mean.y), 4.0 * std::sqrt(2.0 * 25e-10 / (kPi * 3.0) / 2.0 / span_s));
}

/// Mean square between two frequencies, by the discrete Fourier transform of a Hann window's samples.
double bandPower(const std::vector<double>& x, double rate_Hz, double low_Hz, double high_Hz) {
  const auto n = static_cast<double>(x.size());
  double power = 0.0;
  for (int k = static_cast<int>(std::ceil(low_Hz / rate_Hz * n)); k < high_Hz / rate_Hz * n; ++k) {
    const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * k / n);
    std::complex<double> phase = 1.0, sum = 0.0;
    for (size_t i = 0; i < x.size(); ++i) {
      sum += x[i] * (1.0 - std::cos(2.0 * kPi * (static_cast<double>(i) + 0.5) / n)) * phase;
      phase *= turn;
    }
    power += 2.0 * std::norm(sum) / (1.5 * n * n);  // 1.5: mean square of the window
  }
  return power;
}

TEST(GimbalJitter, PeriodogramFollowsTheSpectrum) {
  const double rate_Hz = 400.0;
  const int count = 4000, courses = 6;
  struct Band {
    double low_Hz, high_Hz;
  };
  for (const auto& [low_Hz, high_Hz] : {Band{1.5, 4.5}, Band{8.0, 16.0}, Band{26.0, 34.0}, Band{50.0, 140.0}}) {
    double power = 0.0;
    for (std::uint64_t seed = 0; seed < courses; ++seed) {
      const JitterCourse course({table(), {}}, seed, "seeker");
      std::vector<double> x;
      for (int i = 0; i < count; ++i) x.push_back(course.at(i / rate_Hz).x);
      power += bandPower(x, rate_Hz, low_Hz, high_Hz) / courses;
    }
    // A band of B over T has 1 / sqrt(B T) of deviation, with T / 1.94 that a Hann window leaves of it; courses are apart. Four deviations, and a hundredth
    // for what the window's sides carry over the band's ends.
    const double expected = varianceBelow_rad2(table(), high_Hz) - varianceBelow_rad2(table(), low_Hz);
    figure("jitter: power from " + std::to_string(low_Hz) + " to " + std::to_string(high_Hz) + " Hz [rad2]", power, expected,
           4.0 / std::sqrt((high_Hz - low_Hz) * count / rate_Hz * courses / 1.94) + 0.01,
           "integral of the spectrum; four deviations of 6 periodograms of 10 s");
  }
}

TEST(GimbalJitter, IsAFunctionOfTimeAlone) {
  const Jitter both{table(), table()};
  const JitterCourse course(both, 7, "seeker"), again(both, 7, "seeker"), otherSeed(both, 8, "seeker"), otherCamera(both, 7, "warner");
  const glm::dvec2 late = course.at(3600.125);
  for (int i = 0; i < 100; ++i) EXPECT_NE(course.at(0.01 * i), late);
  EXPECT_EQ(again.at(3600.125), late);
  EXPECT_NE(otherSeed.at(3600.125), late);
  EXPECT_NE(otherCamera.at(3600.125), late);
  // Axes, cameras and seeds are apart: correlations of 4000 numbers over 10 s, deviation sqrt(integral of S^2 / (2 T)) of the variance < 0.06; four of them.
  double axes = 0.0, cameras = 0.0, seeds = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec2 a = course.at(i / 400.0);
    axes += a.x * a.y, cameras += a.x * otherCamera.at(i / 400.0).x, seeds += a.x * otherSeed.at(i / 400.0).x;
  }
  for (const double sum : {axes, cameras, seeds}) EXPECT_LT(std::abs(sum / 4000.0 / kTableVariance), 4.0 * std::sqrt(4e-10 / kTableVariance / 20.0));
  EXPECT_EQ(JitterCourse().at(1.0), glm::dvec2(0.0));
  AxisJitter bad = table();
  bad.spectrum[2].frequency_Hz = 4.0;
  EXPECT_THROW(requireSound(bad), std::invalid_argument);
  bad = {};
  bad.rms_rad = 1e-5;
  EXPECT_THROW(requireSound(bad), std::invalid_argument);
}

/// A Gaussian spot of deviation sigma_px, averaged over each pixel.
void addSpot(std::vector<float>& picture, int width, const glm::dvec2& at, double sigma_px, double sum) {
  const auto share = [&](double middle, int i) {
    const double scale = 1.0 / (sigma_px * std::sqrt(2.0));
    return 0.5 * (std::erf((i + 1 - middle) * scale) - std::erf((i - middle) * scale));
  };
  const int height = static_cast<int>(picture.size()) / width;
  for (int y = std::max(0, static_cast<int>(at.y - 9.0 * sigma_px)); y < std::min<double>(height, at.y + 9.0 * sigma_px); ++y)
    for (int x = std::max(0, static_cast<int>(at.x - 9.0 * sigma_px)); x < std::min<double>(width, at.x + 9.0 * sigma_px); ++x)
      picture[static_cast<size_t>(y * width + x)] += static_cast<float>(sum * share(at.x, x) * share(at.y, y));
}

std::vector<float> noise(int count, double mean, double deviation, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(mean, deviation);
  std::vector<float> picture;
  for (int i = 0; i < count; ++i) picture.push_back(static_cast<float>(normal(engine)));
  return picture;
}

TEST(GimbalCentroid, FindsASpotBetweenPixels) {
  double worst = 0.0;
  Randomly random;
  for (int run = 0; run < 60; ++run) {
    auto picture = noise(64 * 48, 1000.0, 1.0, 100 + static_cast<unsigned>(run));
    const glm::dvec2 at(random(20.0, 44.0), random(15.0, 33.0));
    addSpot(picture, 64, at, 1.2, 9000.0);  // the brightest pixel 1000 deviations up
    const Centroid c = centroidOf(picture, 64, 48, Gate{});
    ASSERT_TRUE(c.found);
    worst = std::max({worst, std::abs(c.at_px.x - at.x), std::abs(c.at_px.y - at.y)});
    EXPECT_NEAR(c.background, 1000.0, 5.0 * 1.2533 / std::sqrt(64.0 * 48.0));  // deviation of a median
    EXPECT_NEAR(c.noise, 1.0, 0.1);                                            // five times 1.17 / sqrt(3072)
    EXPECT_NEAR(c.signal, 9000.0, 90.0);                                       // what lies below the threshold, 1 %
    EXPECT_EQ(std::floor(at.x), c.peak_px.x - 0.5);
  }
  bound("centroid: worst error of 60 spots, sigma 1.2 pixels, peak 1000 deviations [pixels]", worst, 0.02, "0; noise of 1 in 9000 and what the threshold cuts");
}

TEST(GimbalCentroid, NoiseIsFoundAsOftenAsItsQuantileSays) {
  // Three deviations to see any: 1.35e-3 of pixels; at five, 2.9e-7.
  int passed = 0, pictures = 0;
  constexpr int kPictures = 60;
  ThresholdRule three;
  three.sigmas = 3.0;
  for (unsigned seed = 0; seed < kPictures; ++seed) {
    const auto picture = noise(128 * 128, 50.0, 2.0, 1000 + seed);
    passed += centroidOf(picture, 128, 128, Gate{}, three).pixels;
    pictures += centroidOf(picture, 128, 128, Gate{}).found;
  }
  // The threshold is uncertain by 2 % of three deviations and 0.02 of one in each picture: q(3) changes by e^(3 x) - 1 with x = 0.06: 20 % in one, 3 % in 60;
  // the median over a normal 3 % more in the mean; counts of 1327 vary by 3 %. Four deviations.
  figure("centroid: pixels of noise above three deviations", passed / (kPictures * 128.0 * 128.0), 1.3499e-3, 0.2, "normal quantile; four deviations");
  // Expected 60 * 16384 * 2.9e-7 = 0.28 pictures; more than three by chance once in 3000 (Poisson).
  bound("centroid: pictures of noise with a target at five deviations, of 60", pictures, 3, "0.28 expected; more than 3 once in 3000");
}

TEST(GimbalCentroid, FlatBadAndSaturatedPictures) {
  std::vector<float> flat(64 * 48, 7.0f);
  EXPECT_FALSE(centroidOf(flat, 64, 48, Gate{}).found);
  for (size_t i = 0; i < flat.size(); i += 3) flat[i] = std::nextafter(7.0f, 8.0f);  // rounding is no target
  EXPECT_FALSE(centroidOf(flat, 64, 48, Gate{}).found);
  addSpot(flat, 64, {20.3, 30.6}, 1.5, 1.0);  // but a spot without noise is
  const Centroid quiet = centroidOf(flat, 64, 48, Gate{});
  ASSERT_TRUE(quiet.found);
  EXPECT_NEAR(quiet.at_px.x, 20.3, 1e-3);  // what lies below 1e-6 of 7
  EXPECT_NEAR(quiet.at_px.y, 30.6, 1e-3);

  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  auto picture = noise(64 * 48, 100.0, 1.0, 5);
  addSpot(picture, 64, {40.0, 20.0}, 1.2, 5000.0);
  const Centroid before = centroidOf(picture, 64, 48, Gate{});
  for (const size_t at : {3u, 700u, 2000u}) picture[at] = nan, picture[at + 100] = infinite, picture[at + 150] = -infinite;
  const Centroid after = centroidOf(picture, 64, 48, Gate{});
  ASSERT_TRUE(before.found && after.found);
  EXPECT_NEAR(glm::length(after.at_px - before.at_px), 0.0, 1e-3);  // the background moves by some of 3000 ranks
  EXPECT_FALSE(centroidOf(std::vector<float>(64 * 48, nan), 64, 48, Gate{}).found);

  // A clipped spot keeps its middle: it is symmetric.
  ThresholdRule clips;
  clips.saturation = 400.0;
  const Centroid clipped = centroidOf(picture, 64, 48, Gate{}, clips);
  ASSERT_TRUE(clipped.found);
  EXPECT_GT(clipped.saturated, 3);
  EXPECT_NEAR(glm::length(clipped.at_px - glm::dvec2(40.0, 20.0)), 0.0, 0.02);
  EXPECT_LT(clipped.signal, after.signal);
  EXPECT_THROW(centroidOf(picture, 64, 47, Gate{}), std::invalid_argument);
}

TEST(GimbalCentroid, LooksInItsGateAlone) {
  auto picture = noise(128 * 96, 20.0, 1.0, 11);
  addSpot(picture, 128, {30.2, 40.7}, 1.2, 2000.0);
  addSpot(picture, 128, {90.6, 50.1}, 1.2, 4000.0);
  const Centroid dim = centroidOf(picture, 128, 96, {false, {32.0, 42.0}, {10.0, 10.0}}),
                 bright = centroidOf(picture, 128, 96, {false, {88.0, 48.0}, {10.0, 10.0}});
  EXPECT_NEAR(glm::length(dim.at_px - glm::dvec2(30.2, 40.7)), 0.0, 0.03);
  EXPECT_NEAR(glm::length(bright.at_px - glm::dvec2(90.6, 50.1)), 0.0, 0.03);
  EXPECT_FALSE(centroidOf(picture, 128, 96, {false, {60.0, 80.0}, {10.0, 10.0}}).found);
  EXPECT_FALSE(centroidOf(picture, 128, 96, {false, {400.0, 80.0}, {10.0, 10.0}}).found);  // beside the picture
  EXPECT_FALSE(centroidOf(picture, 128, 96, {false, {std::nan(""), -1e300}, {10.0, 10.0}}).found);
  // A step in the background: the gate's border knows, the picture does not.
  for (size_t i = 0; i < picture.size(); ++i) picture[i] += i % 128 >= 64 ? 50.0f : 0.0f;
  ThresholdRule border;
  border.background = ThresholdRule::Background::GateBorder;
  const Centroid local = centroidOf(picture, 128, 96, {false, {88.0, 48.0}, {10.0, 10.0}}, border);
  EXPECT_NEAR(local.background, 70.0, 0.5);
  EXPECT_NEAR(glm::length(local.at_px - glm::dvec2(90.6, 50.1)), 0.0, 0.03);
  // A share of the peak keeps the dim one out.
  ThresholdRule share;
  share.background = ThresholdRule::Background::GateBorder;
  share.shareOfPeak = 0.6;
  EXPECT_LT(centroidOf(picture, 128, 96, {false, {88.0, 48.0}, {10.0, 10.0}}, share).pixels, local.pixels);
}

TEST(GimbalCentroid, TrackerFollowsLosesAndFindsAgain) {
  TrackerOptions options;
  options.gateHalf_px = {8.0, 8.0};
  options.reacquireAfter = 3;
  CentroidTracker tracker(options);
  const auto pictureWith = [](const glm::dvec2& at, double sum, unsigned seed) {
    auto picture = noise(128 * 96, 20.0, 1.0, seed);
    if (sum > 0.0) addSpot(picture, 128, at, 1.2, sum);
    return picture;
  };
  EXPECT_TRUE(tracker.searches());
  glm::dvec2 at(30.0, 30.0);
  for (unsigned k = 0; k < 10; ++k) {
    at += glm::dvec2(3.1, 1.7);
    const Centroid c = tracker.look(pictureWith(at, 3000.0, k), 128, 96);
    ASSERT_TRUE(c.found) << k;
    EXPECT_NEAR(glm::length(c.at_px - at), 0.0, 0.03);
    EXPECT_TRUE(tracker.locked());
  }
  // A brighter light outside the gate does not count.
  auto two = pictureWith(at, 3000.0, 20);
  addSpot(two, 128, {110.0, 10.0}, 1.2, 30000.0);
  EXPECT_NEAR(glm::length(tracker.look(two, 128, 96).at_px - at), 0.0, 0.03);
  for (unsigned k = 0; k < 3; ++k) {
    EXPECT_FALSE(tracker.searches());
    EXPECT_FALSE(tracker.look(pictureWith(at, 0.0, 30 + k), 128, 96).found);
    EXPECT_FALSE(tracker.locked());
  }
  EXPECT_TRUE(tracker.searches());
  const Centroid again = tracker.look(pictureWith({100.4, 80.2}, 3000.0, 40), 128, 96);
  EXPECT_NEAR(glm::length(again.at_px - glm::dvec2(100.4, 80.2)), 0.0, 0.03);
  EXPECT_TRUE(tracker.locked());
}

TEST(GimbalCentroid, FindsASpotInALargePictureEachTime) {
  auto picture = noise(256 * 256, 3000.0, 5.0, 3);
  addSpot(picture, 256, {100.3, 90.1}, 1.5, 20000.0);
  double best_ms = 1e9;
  for (int i = 0; i < 40; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const Centroid c = centroidOf(picture, 256, 256, Gate{});
    best_ms = std::min(best_ms, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    ASSERT_TRUE(c.found);
  }
  std::printf("centroid: 256 x 256, whole picture, best of 40: %.3f ms\n", best_ms);  // told, not tested: machines are slow or not
}

// ---- the loop ----

FollowOptions loopOptions(GimbalDriver driver) {
  FollowOptions o;
  o.driver = driver;
  o.film = film();
  o.camera = "seeker";
  o.tracker.gateHalf_px = {10.0, 10.0};
  return o;
}

std::vector<float> pictureOf(const Pinhole& p, const Pose& camera, const glm::dvec3& target, unsigned seed) {
  auto picture = noise(p.width * p.height, 500.0, 1.0, seed);
  if (const auto at = filmOf(p, glm::conjugate(camera.orientation) * (target - camera.position))) addSpot(picture, p.width, *at, 1.2, 5000.0);
  return picture;
}

constexpr double kTick_s = 0.01;

/// A target that goes round at an even angular rate in the horizon's plane, from the north to the west.
glm::dvec3 roundAt(double rate_rad_s, double time_s) { return 2000.0 * glm::dvec3(-std::sin(rate_rad_s * time_s), std::cos(rate_rad_s * time_s), 0.0); }

const Pose kNorth{{0.0, 0.0, 0.0}, orientationFrom({0.0, 0.0, 0.0})};

TEST(FollowLoop, TruthIsFollowedOneLagBehind) {
  FollowOptions o = loopOptions(GimbalDriver::Truth);
  FollowLoop exact(o);
  o.gimbal.lag_s = 0.03;
  FollowLoop lagged(o);
  for (int k = 0; k <= 100; ++k) {
    const FollowTick now{k * kTick_s, k, kNorth, glm::dvec3(0.0), roundAt(0.4, k * kTick_s)};
    const PoseRow row = exact.tick(now);
    EXPECT_NEAR(glm::length(row.pose.orientation * glm::dvec3(1, 0, 0) - glm::normalize(*now.target)), 0.0, kRounding);
    EXPECT_TRUE(row.locked);
    lagged.tick(now);
  }
  figure("follow: lag of truth through 30 ms at 0.4 rad/s [rad]", 0.4 - lagged.gimbal().angle_rad.x, 0.4 * 0.03, 1e-9, "rate T");
  EXPECT_EQ(lagged.record().size(), 101u);
}

TEST(FollowLoop, ErrorsTurnTheLineOfSightInItsOwnAxes) {
  FollowOptions o = loopOptions(GimbalDriver::Truth);
  o.gimbal.boresight_rad = {0.002, -0.001};
  o.gimbal.roll_rad = 0.3;
  FollowLoop loop(o);
  const glm::dvec3 target(0.0, 500.0, 866.0);
  const PoseRow row = loop.tick({0.0, 0, kNorth, glm::dvec3(0.0), target});
  const glm::dvec3 seen = glm::conjugate(row.pose.orientation) * glm::normalize(target);
  // The target lies right and up of the sight by what the sight lies left and below: 2.2 mrad at any elevation, in axes rolled by 0.3.
  EXPECT_NEAR(std::hypot(seen.y, seen.z), std::hypot(0.002, 0.001), 1e-8);  // second order: 2e-3 cubed
  const glm::dvec2 unrolled(seen.y * std::cos(0.3) - seen.z * std::sin(0.3), seen.y * std::sin(0.3) + seen.z * std::cos(0.3));
  EXPECT_NEAR(unrolled.x, -0.002, 5e-6);
  EXPECT_NEAR(unrolled.y, 0.001, 5e-6);
  // An offset is aimed beside the target, a mirror's scan turns beyond the gimbal.
  o = loopOptions(GimbalDriver::Truth);
  o.gimbal.offset_rad = {0.01, 0.0};
  o.gimbal.scan.kind = Scan::Kind::Conical;
  o.gimbal.scan.radius_rad = 0.02, o.gimbal.scan.frequency_Hz = 25.0;
  FollowLoop beside(o);
  const PoseRow first = beside.tick({0.0, 0, kNorth, glm::dvec3(0.0), glm::dvec3(0.0, 1000.0, 0.0)});
  EXPECT_NEAR(first.angle_rad.x, 0.01, kRounding);
  EXPECT_NEAR(anglesOf(glm::conjugate(kNorth.orientation) * first.pose.orientation * glm::dvec3(1, 0, 0)).x, 0.03, kRounding);
  // Of the gimbal it is demanded.
  o.gimbal.scan.by = Scan::By::Gimbal;
  FollowLoop scans(o);
  EXPECT_NEAR(scans.tick({0.0, 0, kNorth, glm::dvec3(0.0), glm::dvec3(0.0, 1000.0, 0.0)}).angle_rad.x, 0.03, kRounding);
  // Jitter is the course of this camera and seed.
  o = loopOptions(GimbalDriver::Truth);
  o.gimbal.jitter.left = table();
  o.seed = 9;
  FollowLoop shakes(o);
  const PoseRow shaken = shakes.tick({2.0, 0, kNorth, glm::dvec3(0.0), glm::dvec3(0.0, 1000.0, 0.0)});
  EXPECT_NEAR(anglesOf(glm::conjugate(kNorth.orientation) * shaken.pose.orientation * glm::dvec3(1, 0, 0)).x,
              JitterCourse(o.gimbal.jitter, 9, "seeker").at(2.0).x, kRounding);
}

/// Runs a loop on its own pictures; the error of the sight at the last tick, left of the target negative.
double closedLoop(FollowLoop& loop, const FollowOptions& o, double rate_rad_s, int ticks, const std::vector<Pose>& carriers = {}) {
  double error = 0.0;
  for (int k = 0; k <= ticks; ++k) {
    const glm::dvec3 target = roundAt(rate_rad_s, k * kTick_s);
    const Pose carrier = carriers.empty() ? kNorth : carriers[static_cast<size_t>(k)];
    const PoseRow row = loop.tick({k * kTick_s, k, carrier, glm::dvec3(0.0), target});
    const glm::dvec3 seen = glm::conjugate(row.pose.orientation) * target;
    error = std::atan2(seen.y, seen.x);
    loop.look(pictureOf(o.film, row.pose, target, static_cast<unsigned>(k)));
  }
  return error;
}

// Centroids are good to 0.02 pixels of 0.2 mrad.
constexpr double kCentroid_rad = 0.02 * 2e-4;

TEST(FollowLoop, PictureOfATickActsAtTheNext) {
  const double rate = 0.1;
  FollowOptions o = loopOptions(GimbalDriver::Centroid);
  FollowLoop loop(o);
  const double error = closedLoop(loop, o, rate, 60);
  figure("follow: centroid, no lag, 0.1 rad/s at 100 Hz: behind by [rad]", error, rate * kTick_s, kCentroid_rad / (rate * kTick_s),
         "rate times one tick; the centroid's 0.02 pixels");
  EXPECT_TRUE(loop.record().back().locked);
  EXPECT_FALSE(loop.record().front().locked);  // nothing was seen before the first picture
  // With a lag T the demand d_k = line(t_k) stands from t_k to t_k+1: e = rate tick / (1 - exp(-tick / T)).
  o.gimbal.lag_s = 0.012;
  FollowLoop lagged(o);
  const double expected = rate * kTick_s / -std::expm1(-kTick_s / 0.012);
  figure("follow: the same through 12 ms [rad]", closedLoop(lagged, o, rate, 60), expected, kCentroid_rad / expected, "rate tick / (1 - exp(-tick / T))");
  // One tick of latency: one tick more.
  o.gimbal.lag_s = 0.0;
  o.latency_s = kTick_s;
  FollowLoop late(o);
  figure("follow: without lag, a latency of one tick [rad]", closedLoop(late, o, rate, 60), 2.0 * rate * kTick_s, kCentroid_rad / (2.0 * rate * kTick_s),
         "two ticks");
  // What the gimbal does not know of its boresight the picture shows.
  o = loopOptions(GimbalDriver::Centroid);
  o.gimbal.boresight_rad = {0.0015, 0.001};
  FollowLoop corrected(o);
  bound("follow: boresight error left by pictures [rad]", std::abs(closedLoop(corrected, o, 0.0, 20)), kCentroid_rad, "0; the centroid's 0.02 pixels");
}

TEST(FollowLoop, HoldsTheLineInSpaceWhileTheCarrierTurns) {
  std::vector<Pose> turning;
  for (int k = 0; k <= 40; ++k) turning.push_back({glm::dvec3(0.0), orientationFrom({0.05 * std::sin(0.06 * k), 0.03 * k / 40.0, 0.2 * std::sin(0.1 * k)})});
  FollowOptions o = loopOptions(GimbalDriver::Centroid);
  FollowLoop loop(o);
  bound("follow: a target that stands, a carrier that turns: error [rad]", std::abs(closedLoop(loop, o, 0.0, 40, turning)), kCentroid_rad,
        "0; the centroid's 0.02 pixels");
  // Without stabilisation the camera turns with its carrier from picture to picture.
  o.gimbal.stabilised = false;
  FollowLoop carried(o);
  closedLoop(carried, o, 0.0, 39, turning);
  const auto& rows = carried.record();
  const glm::dvec3 was = glm::conjugate(turning[38].orientation) * glm::dvec3(0, 1, 0), demanded = directionOf(rows[39].angle_rad);
  EXPECT_NEAR(glm::length(demanded - was), 0.0, 2.0 * kCentroid_rad);  // both axes
}

TEST(FollowLoop, LostTargetsAreHeldAndFoundAgain) {
  FollowOptions o = loopOptions(GimbalDriver::Centroid);
  FollowLoop loop(o);
  const glm::dvec3 target(0.0, 2000.0, 0.0), jumped(-2.0, 2000.0, 3.0);
  int k = 0;
  const auto tick = [&](const glm::dvec3& drawn) {
    const PoseRow row = loop.tick({k * kTick_s, k, kNorth, glm::dvec3(0.0), std::nullopt});
    loop.look(drawn == glm::dvec3(0.0) ? noise(64 * 48, 500.0, 1.0, 7000 + static_cast<unsigned>(k))
                                       : pictureOf(o.film, row.pose, drawn, static_cast<unsigned>(k)));
    ++k;
    return row;
  };
  for (int i = 0; i < 5; ++i) tick(target);
  const glm::dvec2 before = tick(target).angle_rad;
  for (int i = 0; i < 6; ++i) tick(glm::dvec3(0.0));
  const PoseRow lost = tick(jumped);
  EXPECT_FALSE(lost.locked);
  EXPECT_NEAR(glm::length(lost.angle_rad - before), 0.0, 2.0 * kCentroid_rad);
  const PoseRow again = tick(jumped);
  EXPECT_TRUE(again.locked);
  EXPECT_NEAR(glm::length(again.pose.orientation * glm::dvec3(1, 0, 0) - glm::normalize(jumped)), 0.0, 2.0 * kCentroid_rad);
}

TEST(FollowLoop, CommandsActFromTheTickThatTheyFollow) {
  FollowOptions o = loopOptions(GimbalDriver::Commands);
  o.gimbal.limits.azimuth_rad = 0.5;
  FollowLoop loop(o);
  const auto tick = [&](int k) { return loop.tick({k * kTick_s, k, kNorth, glm::dvec3(0.0), std::nullopt}); };
  EXPECT_EQ(tick(0).angle_rad, glm::dvec2(0.0));
  loop.command({0.2, 0.1});
  EXPECT_NEAR(glm::length(tick(1).angle_rad - glm::dvec2(0.2, 0.1)), 0.0, kRounding);
  loop.commandAlong({100.0, 1000.0, 0.0});  // a little east of north: to the right
  EXPECT_NEAR(tick(2).angle_rad.x, -std::atan2(100.0, 1000.0), kRounding);
  loop.command({0.8, 0.0});
  const PoseRow beyond = tick(3);
  EXPECT_NEAR(beyond.angle_rad.x, 0.5, kRounding);
  EXPECT_FALSE(beyond.locked);
  EXPECT_EQ(beyond.driver, GimbalDriver::Commands);
  EXPECT_THROW(loop.commandAlong(glm::dvec3(0.0)), std::invalid_argument);
  EXPECT_THROW(tick(3), std::invalid_argument);
  EXPECT_THROW(FollowLoop(o).look({}), std::invalid_argument);
}

TEST(FollowLoop, DuringAFrameItGoesOnAsTheNextTickSays) {
  FollowOptions o = loopOptions(GimbalDriver::Truth);
  o.gimbal.lag_s = 0.02;
  o.gimbal.jitter.up = table();
  FollowLoop loop(o);
  for (int k = 0; k < 20; ++k) loop.tick({k * kTick_s, k, kNorth, glm::dvec3(0.0), roundAt(0.4, k * kTick_s)});
  const FollowTick next{20 * kTick_s, 20, kNorth, glm::dvec3(0.0), roundAt(0.4, 20 * kTick_s)};
  const Pose ahead = loop.during(next);
  EXPECT_EQ(loop.record().size(), 20u);
  EXPECT_EQ(ahead.orientation, loop.tick(next).pose.orientation);
  EXPECT_THROW(loop.during({0.0, 0, kNorth, glm::dvec3(0.0), std::nullopt}), std::invalid_argument);
}

TEST(FollowLoop, SaysWhatItsFirstTickDemands) {
  FollowOptions o = loopOptions(GimbalDriver::Truth);
  o.gimbal.limits.azimuth_rad = 0.3;
  FollowLoop loop(o);
  const FollowTick first{0.0, 0, kNorth, glm::dvec3(0.0), glm::dvec3(-1000.0, 1000.0, 0.0)};
  EXPECT_NEAR(beyondLimits(o.gimbal.limits, loop.demandAtStart(first)).x, 0.25 * kPi - 0.3, kRounding);
  const PoseRow row = loop.tick(first);
  EXPECT_NEAR(row.angle_rad.x, 0.3, kRounding);
  EXPECT_FALSE(row.locked);
}

// ---- the record ----

std::string recordOf(const std::vector<PoseRow>& rows) {
  std::string text = posesHeader();
  for (const PoseRow& row : rows) text += poseLine(row);
  return text;
}

TEST(GimbalPoses, AreReadBackToTheBitAndReplayed) {
  FollowOptions o = loopOptions(GimbalDriver::Centroid);
  o.gimbal.jitter.left = table();
  o.gimbal.lag_s = 0.02;
  FollowLoop loop(o);
  closedLoop(loop, o, 0.1, 30);
  const PoseRecord record = posesOf("# a comment\r\n\n" + recordOf(loop.record()), "seeker_poses.csv");
  ASSERT_EQ(record.rows.size(), loop.record().size());
  for (size_t i = 0; i < record.rows.size(); ++i) {
    const PoseRow &a = record.rows[i], &b = loop.record()[i];
    EXPECT_EQ(a.time_s, b.time_s);
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_EQ(a.pose.orientation, b.pose.orientation);
    EXPECT_EQ(a.pose.position, b.pose.position);
    EXPECT_EQ(a.angle_rad, b.angle_rad);
    EXPECT_EQ(a.driver, b.driver);
    EXPECT_EQ(a.locked, b.locked);
  }
  // A frame by itself looks where it looked in the run.
  FollowLoop replay(o, record);
  const PoseRow row = replay.tick({17 * kTick_s, 17, kNorth, glm::dvec3(0.0), std::nullopt});
  EXPECT_EQ(row.pose.orientation, loop.record()[17].pose.orientation);
  EXPECT_EQ(row.driver, GimbalDriver::Poses);
  EXPECT_THROW(replay.tick({31 * kTick_s, 31, kNorth, glm::dvec3(0.0), std::nullopt}), UserError);
  EXPECT_EQ(posesFileName("seeker"), "seeker_poses.csv");
}

TEST(GimbalPoses, SayWhereTheyAreWrong) {
  const std::string header = posesHeader(), sound = "0,0,1,0,0,0,1,2,3,0.1,0.2,truth,1\n";
  const auto messageOf = [](const std::string& text) -> std::string {
    try {
      posesOf(text, "p.csv");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(messageOf(header + sound), "");
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"", "p.csv:1:1: no poses"},
      {header, "p.csv:1:1: no poses"},
      {"time_s,frame,qw\n", "p.csv:1:14: not the header"},
      {"time,frame,qw\n", "p.csv:1:1: not the header"},
      {header + "0,0,1\n", "p.csv:2:1: a row of 3 cells"},
      {header + "0,0,1,0,x,0,1,2,3,0.1,0.2,truth,1\n", "p.csv:2:9: not a finite number: 'x'"},
      {header + "nan,0,1,0,0,0,1,2,3,0.1,0.2,truth,1\n", "p.csv:2:1: not a finite number"},
      {header + "0,0.5,1,0,0,0,1,2,3,0.1,0.2,truth,1\n", "p.csv:2:3: not a whole number"},
      {header + "0,0,1,0.1,0,0,1,2,3,0.1,0.2,truth,1\n", "p.csv:2:5: a quaternion of length 1.00"},
      {header + "0,0,1,0,0,0,1,2,3,0.1,0.2,ghost,1\n", "p.csv:2:27: no driver is called 'ghost'; expected truth, centroid, commands, poses"},
      {header + "0,0,1,0,0,0,1,2,3,0.1,0.2,truth,2\n", "p.csv:2:33: not a lock"},
      {header + sound + "0,1,1,0,0,0,1,2,3,0.1,0.2,truth,1\n", "p.csv:3:1: a time that does not rise"},
      {header + sound + "1,0,1,0,0,0,1,2,3,0.1,0.2,truth,1\n", "p.csv:3:3: a frame that does not rise"}};
  for (const auto& [text, message] : wrong) EXPECT_EQ(messageOf(text).substr(0, message.size()), message);
  try {
    readPoses("no_such_poses.csv", {"command line", 0, 0, -1});
    FAIL();
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("no_such_poses.csv"), std::string::npos);
  }
  for (const GimbalDriver driver : {GimbalDriver::Truth, GimbalDriver::Centroid, GimbalDriver::Commands, GimbalDriver::Poses})
    EXPECT_EQ(gimbalDriverOf(nameOf(driver)), driver);
}

}  // namespace
}  // namespace pitviper::test
