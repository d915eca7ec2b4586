// What a camera sees of each body, by rays: against places, sizes and shares worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/frame/seen_bodies.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

std::string body(const std::string& name, const std::string& shape, const std::string& place, const std::string& material = "m") {
  return "  - {name: " + name + ", shape: {model: " + shape + "}, material: " + material + ", temperature: 300 K, " + place + "}\n";
}

/// A camera at the origin that looks north: 100 x 100 pixels of 1 mrad on its axis.
std::vector<BodySight> seen(const std::string& bodies, const std::string& more = "") {
  const Simulation sim =
      test::scene("materials: {m: {}, glass: {transmission: {transmittance: 0.5}}, gas: {absorption: 0.1 /m}}\nentities:\n" + bodies +
                  "cameras: [{name: c, film: {width: 100, height: 100, pitch: 50 um}, focal_length: 50 mm, aperture: 5 mm, position: [0 m, 0 "
                  "m, 0 m], heading: 0 deg, pitch: 0 deg, channels: [{name: lw, response: {band: [8 um, 9 um]}}]" +
                  more + "}]\n");
  return bodiesSeen(sim, sim.cameras.at(0), advance(sim, 0.0));
}

const std::string kPlate = "plate, width: 2 m, height: 1 m", kNorth = ", heading: 180 deg";

TEST(SeenBodies, SizeRangeAndPixels) {
  const auto s = seen(body("b", kPlate, "position: [0 m, 100 m, 0 m]" + kNorth)).at(0);
  EXPECT_EQ(s.sight, HowSeen::InView);
  EXPECT_NEAR(s.range_m, 100.0, 1e-9);
  EXPECT_NEAR(s.width_px, 20.0, 1e-4);  // 2 m at 100 m: 20 mrad
  EXPECT_NEAR(s.height_px, 10.0, 1e-4);
  EXPECT_NEAR(s.size_m.y, 2.0, 1e-6);
  EXPECT_FALSE(s.cut);
  EXPECT_EQ(s.hidden, 0.0);
}

TEST(SeenBodies, OutOfViewBehindCutAndNear) {
  const auto s = seen(body("beside", kPlate, "position: [20 m, 100 m, 0 m]" + kNorth) + body("behind", kPlate, "position: [0 m, -100 m, 0 m]" + kNorth) +
                      body("edge", kPlate, "position: [5 m, 100 m, 0 m]" + kNorth) + body("near", kPlate, "position: [0 m, 0.05 m, 0 m]" + kNorth) +
                      body("corner", "sphere, radius: 1 m", "position: [5.8 m, 100 m, 5.8 m]"));
  EXPECT_EQ(s[0].sight, HowSeen::OutOfView);
  EXPECT_EQ(s[1].sight, HowSeen::Behind);
  EXPECT_EQ(s[2].sight, HowSeen::InView);
  EXPECT_TRUE(s[2].cut);
  EXPECT_EQ(s[3].sight, HowSeen::TooNear);
  EXPECT_EQ(s[4].sight, HowSeen::OutOfView);  // its box reaches over the film's corner, the sphere does not
}

TEST(SeenBodies, HiddenWhollyAndByHalf) {
  const auto all =
      seen(body("b", kPlate, "position: [0 m, 100 m, 0 m]" + kNorth) + body("wall", "plate, width: 3 m, height: 3 m", "position: [0 m, 90 m, 0 m]" + kNorth));
  EXPECT_EQ(all[0].sight, HowSeen::Hidden);
  EXPECT_EQ(all[0].hiddenBy, 1);
  EXPECT_EQ(all[1].sight, HowSeen::InView);
  const auto half =
      seen(body("b", kPlate, "position: [0 m, 100 m, 0 m]" + kNorth) + body("wall", "plate, width: 3 m, height: 3 m", "position: [1.5 m, 90 m, 0 m]" + kNorth));
  EXPECT_EQ(half[0].sight, HowSeen::InView);
  EXPECT_NEAR(half[0].hidden, 0.5, 0.06);  // of 96 places
  EXPECT_EQ(half[0].hiddenBy, 1);
}

TEST(SeenBodies, ThroughGlassAndGas) {
  const auto glass = seen(body("b", kPlate, "position: [0 m, 100 m, 0 m]" + kNorth) +
                          body("pane", "plate, width: 3 m, height: 3 m", "position: [0 m, 90 m, 0 m]" + kNorth, "glass"));
  EXPECT_EQ(glass[0].sight, HowSeen::InView);
  EXPECT_EQ(glass[0].through, 1);
  EXPECT_EQ(glass[0].hidden, 0.0);
  const auto gas = seen(body("b", kPlate, "position: [0 m, 100 m, 0 m]" + kNorth) + body("puff", "sphere, radius: 3 m", "position: [0 m, 90 m, 0 m]", "gas"));
  EXPECT_EQ(gas[0].through, 1);
  EXPECT_EQ(gas[1].sight, HowSeen::InView);
}

// What is smaller than the grid of rays over the film is found by places on it; what its places miss, because it is far larger than the film, by the grid.
TEST(SeenBodies, SmallAndLarge) {
  const auto s = seen(body("speck", "sphere, radius: 1 cm", "position: [0 m, 100 m, 0 m]") +
                      body("field", "plate, width: 100 km, height: 100 km", "position: [0 m, 0 m, -3 m], pitch: 90 deg"));
  EXPECT_EQ(s[0].sight, HowSeen::InView);
  EXPECT_NEAR(s[0].width_px, 0.2, 0.001);
  EXPECT_EQ(s[1].sight, HowSeen::InView);
  EXPECT_TRUE(std::isinf(s[1].width_px));
  EXPECT_EQ(s[1].hidden, 0.0);
}

TEST(SeenBodies, ACarrierIsNotSeen) {
  const auto s = seen(body("b", "sphere, radius: 1 m", "position: [0 m, 0 m, 0 m], heading: 0 deg"), ", attached_to: b");
  EXPECT_EQ(s[0].sight, HowSeen::Carrier);
}

}  // namespace
}  // namespace pitviper
