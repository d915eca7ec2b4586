// What a window shows and writes: scales against their closed forms; what was changed by hand, read back as keys of the scenario.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/view/display_scale.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/view/hand_changes.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(WindowValues, ScalesAreTheirClosedForms) {
  std::vector<float> squares;  // a thousandth of the pixels each
  for (int k = 0; k <= 1000; ++k) squares.push_back(static_cast<float>(k * k));
  const DisplayScale line(ScaleKind::Linear, 10.0, 30.0, squares), log(ScaleKind::Logarithmic, 1.0, 1e4, squares),
      even(ScaleKind::Histogram, 0.0, 1e6, squares);
  EXPECT_DOUBLE_EQ(line.position(15.0), 0.25);
  EXPECT_DOUBLE_EQ(log.position(100.0), 0.5);
  // Of squares of even numbers the share below v is its root; between 64 quantiles they are lines.
  for (double v : {1e4, 2.5e5, 8.1e5}) EXPECT_NEAR(even.position(v), std::sqrt(v) / 1000.0, 1.0 / 64.0 / 8.0);
  for (const DisplayScale* s : {&line, &log, &even})
    for (double p : {0.1, 0.5, 0.9}) EXPECT_NEAR(s->position(s->value(p)), p, 1e-12);
  EXPECT_EQ(line.position(-1e9), 0.0);
  EXPECT_EQ(log.position(-1.0), 0.0);
  EXPECT_EQ(line.position(NAN), 0.0);
  const auto [low, high] = DisplayScale::endsOf(squares);
  EXPECT_NEAR(low, 25.0, 12.0);  // five thousandths from below
  EXPECT_NEAR(high, 998.0 * 998.0, 2100.0);
}

// A camera that was flown stands where its keys say, whatever it looked at and whatever carries it.
TEST(WindowValues, HandsComeBackAsKeys) {
  const std::string begin =
      "background: {temperature: 250 K}\nentities:\n  - {name: ball, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 320 K, position: "
      "[300 m, 40 m, "
      "20 m], heading: 33 deg, pitch: 12 deg}\nlights: [{name: lamp, intensity: 3 W/(sr um), position: [0 m, 0 m, 9 m]}]\n"
      "cameras:\n  - {name: c, film: {width: 16, height: 12}, field_of_view: 10 deg, aperture: 5 mm, channels: [{name: mw, response: {band: [3.6 um, 4.9 "
      "um]}}], ";
  for (const char* where :
       {"position: [0 m, 0 m, 5 m], look_at: ball}", "position: [0 m, 0 m, 5 m], heading: 80 deg, pitch: 3 deg}",
        "attached_to: ball, position: [2 m, 0 m, 0 m], heading: 10 deg}", "attached_to: ball, position: [2 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m]}"}) {
    const Simulation sim = scene(begin + where + "\n");
    HandChanges hands;
    hands.flown["c"] = {{12.0, -7.0, 31.0}, orientationFrom({1.1, -0.2, 0.0})};
    hands.focalLengths_m["c"] = 2.0 * sim.cameras[0].pinhole.focalLength_m;
    hands.temperatures_K[{0, 0}] = 341.0;
    hands.lightLevels[0] = 0.25;
    std::vector<std::string> sets;
    for (const YamlChange& k : keysOf(sim, hands, 0.0)) sets.push_back(k.path + "=" + k.value);
    const Simulation written = readScenarioText(begin + where + "\n", "hands", ".", sets, findLibraries());
    const WorldState world = advance(written, 0.0), shown = worldWith(sim, hands, 0.0)(0.0);
    const CameraState is = cameraAt(written.cameras[0], world), asked = cameraAt(sim.cameras[0], shown);
    // Seven digits are written, of a direction by a point 1 km ahead.
    EXPECT_LT(glm::length(is.pose.position - asked.pose.position), 1e-3) << where;
    EXPECT_GT(glm::dot(is.pose.orientation * glm::dvec3(1, 0, 0), asked.pose.orientation * glm::dvec3(1, 0, 0)), 1.0 - 1e-10) << where;
    // A field of view: of focal length and pitch the one that the film does not say follows.
    EXPECT_NEAR(is.pinhole.tanX(0.0) / asked.pinhole.tanX(0.0), 1.0, 1e-5) << where;
    EXPECT_EQ(world.temperatures_K[0][0], shown.temperatures_K[0][0]);
    EXPECT_EQ(world.lightLevels[0], shown.lightLevels[0]);
  }
}

}  // namespace
}  // namespace pitviper::test
