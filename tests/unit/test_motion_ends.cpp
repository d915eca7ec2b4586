// What motions do at their ends, turns beyond 360 degrees, velocities, and who is there when.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/trajectory.hpp"
#include "sim/world/world.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::vector<Waypoint> path() {
  std::vector<Waypoint> all(3);
  all[0].position = {0.0, 0.0, 0.0};
  all[1].time_s = 1.0, all[1].position = {10.0, 0.0, 0.0};
  all[2].time_s = 3.0, all[2].position = {10.0, 40.0, 8.0};
  return all;
}

double apart(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

TEST(MotionEnds, HoldGoOnLoopVanish) {
  for (auto how : {Motion::Interpolation::Linear, Motion::Interpolation::Smooth}) {
    const Motion hold(path(), how), on(path(), how, AtEnd::GoOn, AtEnd::GoOn), loop(path(), how, AtEnd::Loop, AtEnd::Loop),
        gone(path(), how, AtEnd::Vanish, AtEnd::Vanish);
    EXPECT_EQ(hold.at(9.0).position, path()[2].position);
    EXPECT_EQ(hold.velocityAt(9.0), glm::dvec3(0.0));
    // From the last point on with the velocity there: for both interpolations that of the last leg.
    EXPECT_LT(apart(on.at(5.0).position, glm::dvec3(10.0, 80.0, 16.0)), 1e-12);
    EXPECT_LT(apart(on.at(-2.0).position, glm::dvec3(-20.0, 0.0, 0.0)), 1e-12);
    EXPECT_LT(apart(on.velocityAt(5.0), glm::dvec3(0.0, 20.0, 4.0)), 1e-12);
    for (double t : {0.3, 1.7, 2.9}) {
      EXPECT_LT(apart(loop.at(t + 6.0).position, hold.at(t).position), 1e-12);
      EXPECT_LT(apart(loop.at(t - 3.0).position, hold.at(t).position), 1e-12);
    }
    EXPECT_FALSE(gone.presentAt(-0.01));
    EXPECT_TRUE(gone.presentAt(0.0));
    EXPECT_TRUE(gone.presentAt(3.0));
    EXPECT_FALSE(gone.presentAt(3.01));
    EXPECT_TRUE(hold.presentAt(99.0));
  }
}

TEST(MotionEnds, VelocityIsTheSlopeOfThePlace) {
  for (auto how : {Motion::Interpolation::Linear, Motion::Interpolation::Smooth}) {
    const Motion m(path(), how, AtEnd::GoOn, AtEnd::Loop);
    for (double t : {-1.0, 0.4, 1.6, 2.8, 4.1}) {
      const double h = 1e-5;
      // Central difference: third derivatives of at most 100 m/s^3 leave h^2/6 of them, rounding 1e-15 x 100 / h.
      EXPECT_LT(apart(m.velocityAt(t), (m.at(t + h).position - m.at(t - h).position) / (2.0 * h)), 1e-7) << t;
    }
  }
}

TEST(MotionEnds, SpinsBeyondATurn) {
  Pose pose;
  pose.orientation = orientationFrom({0.5, 0.2, 0.0});
  Spin even;
  even.rate_rad_s = 4.0 * kPi;  // two turns a second
  const Motion fixed(pose), spun = fixed.withSpin(even);
  EXPECT_FALSE(spun.isStill());
  EXPECT_TRUE(fixed.isStill());
  const auto left = [](const Motion& m, double t) { return m.at(t).orientation * glm::dvec3(0, 1, 0); };
  EXPECT_LT(apart(left(spun, 7.0), left(fixed, 0.0)), 1e-12);
  EXPECT_LT(apart(left(spun, 7.25), -left(fixed, 0.0)), 1e-12);
  // Right-handed about x: left goes up.
  EXPECT_LT(apart(left(spun, 7.125), fixed.at(0.0).orientation * glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(apart(spun.at(3.3).orientation * glm::dvec3(1, 0, 0), fixed.at(0.0).orientation * glm::dvec3(1, 0, 0)), 1e-12);
  Spin course;
  course.angle_rad = TimeCourse({{0.0, 0.0}, {2.0, 8.0 * kPi}});  // 1440 deg in 2 s
  EXPECT_LT(apart(left(fixed.withSpin(course), 0.125), fixed.at(0.0).orientation * glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(apart(left(fixed.withSpin(course), 5.0), left(fixed, 0.0)), 1e-12);
}

TEST(MotionEnds, OfATrajectory) {
  std::vector<TrajectoryPoint> points(2);
  points[0].velocity = points[1].velocity = {100.0, 0.0, 0.0};
  points[1].time_s = 2.0, points[1].position = {200.0, 0.0, 0.0};
  const Motion m(Trajectory(points, AtEnd::Vanish, AtEnd::GoOn));
  EXPECT_FALSE(m.presentAt(-0.1));
  EXPECT_TRUE(m.presentAt(50.0));
  EXPECT_EQ(m.before(), AtEnd::Vanish);
  EXPECT_EQ(m.end_s(), 2.0);
  EXPECT_LT(apart(m.at(3.0).position, {300.0, 0.0, 0.0}), 1e-12);
  EXPECT_LT(apart(m.velocityAt(1.0), {100.0, 0.0, 0.0}), 1e-12);
  EXPECT_FALSE(m.isStill());
}

TEST(Lifetimes, BodiesChildrenAndLights) {
  const Simulation sim = scene(
      "time: {rate: 10 Hz, frames: 20}\n"
      "entities:\n"
      "  - {name: a, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K, begin: 0.3 s, end: 1 s}\n"
      "  - {name: child, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K, attached_to: a}\n"
      "  - {name: b, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K, begin: 1 s}\n"
      "  - {name: passing, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K, ends: vanish, motion: [{time: 0.5 s, position: [0 m, "
      "0 m, 0 m]}, "
      "{time: 0.7 s, position: [5 m, 0 m, 0 m]}]}\n"
      "lights: [{name: l, intensity: 1 W/(sr um), attached_to: a}, {name: m, intensity: 1 W/(sr um), position: [0 m, 0 m, 0 m], end: 0.5 s}]\n"
      "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 mm, position: [20 m, 0 m, 0 m], look_at: a, channels: [{name: x, "
      "response: {band: [3 um, "
      "5 um]}}]}]\n");
  const auto there = [&](int frame) {
    const WorldState s = advance(sim, sim.time.at(frame));
    std::string text;
    for (size_t e = 0; e < 4; ++e) text += s.isThere(e) ? "1" : "0";
    for (double level : s.lightLevels) text += level > 0.0 ? "1" : "0";
    return text;
  };
  EXPECT_EQ(there(0), "000001");
  EXPECT_EQ(there(2), "000001");
  EXPECT_EQ(there(3), "110011");  // 3 x 0.1 s is above 0.3 s by rounding, and the same
  EXPECT_EQ(there(5), "110110");
  EXPECT_EQ(there(6), "110110");
  EXPECT_EQ(there(8), "110010");
  EXPECT_EQ(there(10), "001000");  // one follows the other without a gap or both
  EXPECT_EQ(lifetimeOf(sim, 1).begin_s, 0.3);
  EXPECT_EQ(lifetimeOf(sim, 3).end_s, 0.7);
}

}  // namespace
}  // namespace pitviper::test
