// What a stabilised mount keeps of its carrier's attitude from a camera.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/parameters/error.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A body that goes through these attitudes [deg], 1 s apart, and a camera on it.
Simulation carried(const std::vector<Attitude>& attitudes_deg, const std::string& camera) {
  std::string points;
  for (std::size_t k = 0; k < attitudes_deg.size(); ++k)
    points += print("%s{time: %zu s, position: [%zu m, 0 m, 500 m], heading: %.9g deg, pitch: %.9g deg, roll: %.9g deg}", k ? ", " : "", k, 100 * k,
                    attitudes_deg[k].heading_rad, attitudes_deg[k].pitch_rad, attitudes_deg[k].roll_rad);
  return scene("time: {rate: 1 Hz, frames: " + std::to_string(attitudes_deg.size()) +
               "}\nentities:\n  - {name: missile, shape: {model: sphere, radius: 1 cm}, material: blackbody, temperature: 300 K, motion: [" + points +
               "]}\n  - {name: far, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K, position: [9 km, 0 m, 500 m]}\n"
               "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 mm, attached_to: missile, " +
               camera + "channels: [{name: x, response: {band: [3 um, 5 um]}}]}]\n");
}

std::vector<Attitude> anyAttitudes(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::vector<Attitude> all;
  for (int k = 0; k < 12; ++k) all.push_back({180.0 + 179.0 * part(random), 80.0 * part(random), 179.0 * part(random)});
  return all;
}

double apart(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); }

// Of a camera that looks along its carrier: what is held is that of the horizon or of the start, what is not is the carrier's.
TEST(StabilisedMount, HoldsWhatItIsAskedFor) {
  struct Case {
    const char* text;
    bool heading, pitch, roll;
  };
  for (const Case& c : {Case{"roll", false, false, true},
                        {"[roll]", false, false, true},
                        {"pitch", false, true, false},
                        {"yaw", true, false, false},
                        {"[roll, pitch]", false, true, true},
                        {"[yaw, pitch, roll]", true, true, true}})
    for (unsigned seed : {1u, 2u, 3u}) {
      const auto asked = anyAttitudes(seed);
      const Simulation sim = carried(asked, print("position: [2 m, 0 m, 0.5 m], stabilised: %s, ", c.text));
      double worst = 0.0, place = 0.0;
      for (int k = 0; k < 12; ++k) {
        const WorldState state = advance(sim, k);
        const Pose& body = state.entities[0];
        const Attitude is = attitudeOf(cameraAt(sim.cameras[0], state).pose.orientation), was = attitudeOf(body.orientation),
                       start = attitudeOf(advance(sim, 0.0).entities[0].orientation);
        worst = std::max({worst, apart(is.heading_rad, c.heading ? start.heading_rad : was.heading_rad), apart(is.pitch_rad, c.pitch ? 0.0 : was.pitch_rad),
                          apart(is.roll_rad, c.roll ? 0.0 : was.roll_rad)});
        place = std::max(place, glm::length(cameraAt(sim.cameras[0], state).pose.position - body.position - body.orientation * glm::dvec3(2, 0, 0.5)));
      }
      // asin near 80 deg raises rounding by 6.
      bound(print("stabilised: %s, angles off [rad], seed %u", c.text, seed), worst, 1e-12, "0: angles of the horizon, the start or the carrier; rounding");
      bound(print("stabilised: %s, place off [m], seed %u", c.text, seed), place, 1e-9, "it goes with its carrier");
    }
}

// Its own heading, pitch and roll come on top of the platform: a camera that looks to the side of a body that banks stays level.
TEST(StabilisedMount, OwnAnglesComeOnTop) {
  const Simulation sim = carried({{90, 0, 0}, {90, 0, 60}, {90, 0, -45}}, "heading: 90 deg, pitch: -10 deg, stabilised: roll, "),
                   loose = carried({{90, 0, 0}, {90, 0, 60}}, "heading: 90 deg, pitch: -10 deg, ");
  for (int k = 0; k < 3; ++k) {
    const Attitude is = attitudeOf(cameraAt(sim.cameras[0], advance(sim, k)).pose.orientation);
    EXPECT_NEAR(is.heading_rad, kPi, 1e-12) << k;
    EXPECT_NEAR(is.pitch_rad, -10.0 * kPi / 180.0, 1e-12) << k;
    EXPECT_NEAR(is.roll_rad, 0.0, 1e-12) << k;
  }
  // Without it a bank to the right looks down to the right: by 60 and 10 deg.
  EXPECT_NEAR(attitudeOf(cameraAt(loose.cameras[0], advance(loose, 1.0)).pose.orientation).pitch_rad, -70.0 * kPi / 180.0, 1e-9);
}

// A gimbal stands on the platform: its picture is upright while the missile banks, and it looks at its target all the same.
TEST(StabilisedMount, IsTheBaseOfAGimbal) {
  const Simulation sim = carried({{90, 0, 0}, {88, 3, 75}, {94, -4, -170}}, "look_at: far, gimbal: {}, stabilised: roll, "),
                   loose = carried({{90, 0, 0}, {88, 3, 75}, {94, -4, -170}}, "look_at: far, gimbal: {}, ");
  for (int k = 0; k < 3; ++k) {
    const auto lookingAt = [&](const Simulation& s) {
      auto follower = s.cameras[0].follower->make(s, s.cameras[0]);
      Pose pose;
      for (int t = 0; t <= k; ++t) pose = follower->tick(followerTick(s.cameras[0], advance(s, t), t)).pose;
      return pose;
    };
    const Pose pose = lookingAt(sim), rolled = lookingAt(loose);
    const glm::dvec3 to = glm::normalize(glm::dvec3(9000, 0, 500) - pose.position);
    EXPECT_LT(glm::length(pose.orientation * glm::dvec3(1, 0, 0) - to), 1e-9) << k;
    EXPECT_LT(glm::length(rolled.orientation * glm::dvec3(1, 0, 0) - to), 1e-9) << k;
    // Two axes on a platform pitched by 4 deg, 4 deg aside: the picture turns by sin(4 deg) x 4 deg = 0.3 deg at most.
    EXPECT_LT(std::abs(attitudeOf(pose.orientation).roll_rad), 0.006) << k;
    if (k > 0) {
      EXPECT_GT(std::abs(attitudeOf(rolled.orientation).roll_rad), 1.0) << k;
    }
  }
}

TEST(StabilisedMount, RefusesWhatIsNone) {
  const auto refusal = [](const std::string& camera, bool isCarried = true) -> std::string {
    try {
      if (isCarried) (void)carried({{90, 0, 0}, {90, 0, 60}}, camera);
      else
        (void)scene("cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, " +
                    camera + "channels: [{name: x, response: {band: [3 um, 5 um]}}]}]\n");
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("stabilised: bank, ").find("a mount has no angle 'bank'; expected one of roll, pitch, yaw"), std::string::npos)
      << refusal("stabilised: bank, ");
  EXPECT_NE(refusal("stabilised: true, ").find("a mount has no angle 'true'"), std::string::npos);
  EXPECT_NE(refusal("stabilised: heading, ").find("yaw"), std::string::npos);
  EXPECT_NE(refusal("stabilised: [roll, roll], ").find("'roll' twice"), std::string::npos);
  EXPECT_NE(refusal("stabilised: [], ").find("no angle to hold"), std::string::npos);
  EXPECT_NE(refusal("stabilised: roll, look_at: far, ").find("a 'gimbal' on it"), std::string::npos);
  for (const char* own : {"roll", "[roll]", "[pitch, yaw]"}) {
    const std::string said = refusal(std::string("look_at: far, gimbal: {stabilised: ") + own + "}, ");
    EXPECT_NE(said.find("'stabilised' of the camera, beside 'gimbal'"), std::string::npos) << said;
  }
  EXPECT_EQ(refusal("look_at: far, gimbal: {stabilised: false}, "), "");
  EXPECT_NE(refusal("stabilised: roll, ", false).find("nothing carries"), std::string::npos);
}

}  // namespace
}  // namespace pitviper::test
