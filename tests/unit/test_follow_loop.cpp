// The loop that points a camera, and the record of what it did.
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
  EXPECT_THROW(FollowLoop(o).during(next), std::invalid_argument);
}

// An exposure begins before its frame's time: then the camera is where the ticks before have brought it; before the first tick it stands where it starts.
TEST(FollowLoop, BeforeATickItWasWhereTheOneBeforeLeftIt) {
  FollowOptions o = loopOptions(GimbalDriver::Truth);
  o.gimbal.lag_s = 0.02;
  const auto tick = [](double time_s, int k) { return FollowTick{time_s, k, kNorth, glm::dvec3(0.0), roundAt(0.4, time_s)}; };
  FollowLoop loop(o), finer(o);
  for (int k = 0; k < 20; ++k) loop.tick(tick(k * kTick_s, k));
  Pose expected;
  for (int k = 0; k < 39; ++k) {
    const PoseRow row = finer.tick(tick(0.5 * k * kTick_s, k));
    if (k == 37) expected = row.pose;
  }
  const Pose between = loop.during(tick(18.5 * kTick_s, 0));
  // The target goes round; between ticks the loop takes its angles for even: off by its angular acceleration, which is 0.
  EXPECT_NEAR(std::abs(glm::dot(between.orientation, expected.orientation)), 1.0, kRounding);
  FollowLoop first(o);
  const PoseRow start = first.tick(tick(0.0, 0));
  EXPECT_EQ(first.during(tick(-0.1, 0)).orientation, start.pose.orientation);
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
