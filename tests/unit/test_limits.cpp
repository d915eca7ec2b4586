// The limits of a scenario: how they are read, and what is beyond them.
#include <gtest/gtest.h>

#include "sim/frame/limits_check.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const std::string kScene =
    "entities:\n- {name: p, shape: {model: sphere, radius: 10 m, fit: inscribed}, material: {}, temperature: 300 K, position: [0 m, 1 km, 0 m]}\n"
    "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 20 mm, heading: 0 deg, channels: [{name: a, response: {band: [3 um, 5 "
    "um]}}]}]\n";

std::string errorOf(const std::string& limits) {
  try {
    scene("limits: " + limits + "\n" + kScene);
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Limits, AreReadInSi) {
  const Limits l = scene("limits: {range: [100 m, 20 km], temperature: [-20 degC, 900 K], light: 1.5}\n" + kScene).limits;
  EXPECT_DOUBLE_EQ(l.nearest_m, 100.0);
  EXPECT_DOUBLE_EQ(l.farthest_m, 20e3);
  EXPECT_DOUBLE_EQ(l.coldest_K, 253.15);
  EXPECT_DOUBLE_EQ(l.hottest_K, 900.0);
  EXPECT_DOUBLE_EQ(l.lightLevel, 1.5);
  EXPECT_FALSE(scene(kScene).limits.any());
  const Limits light = scene("limits: {light: 3}\n" + kScene).limits;
  EXPECT_TRUE(light.any());
  EXPECT_EQ(light.farthest_m, 0.0);
  EXPECT_EQ(describe(light), "lights to level 3");
  EXPECT_EQ(describe(l), "bodies at 100 m to 20 km, at 253.1 K to 900 K, lights to level 1.5");
}

TEST(Limits, MistakesAreTold) {
  for (const auto& [limits, place, parts] : {
           std::tuple{"{range: [20 km, 100 m]}", "test.yaml:1:17: ", std::vector{"range of limits goes from 20 km to 100 m", "swap its ends"}},
           {"{range: [1 km, 1 km]}", "test.yaml:1:17: ", {"range of limits goes from 1 km to 1 km", "two rising values", "write 'range: [100 m, 20 km]'"}},
           {"{range: [0 m, 20 km]}", "test.yaml:1:18: ", {"range of limits has an end at 0 m", "above 0"}},
           {"{range: [100 m, 2e9 m]}", "test.yaml:1:25: ", {"range of limits has an end at 2e9 m", "at most 1e+09 m"}},
           {"{range: [100, 20 km]}", "test.yaml:1:18: ", {"range of limits has no unit"}},
           {"{range: 20 km}", "test.yaml:1:17: ", {"range is a single value"}},
           {"{range: [1 km]}", "test.yaml:1:17: ", {"range has 1 entries"}},
           {"{temperature: [900 K, 250 K]}", "test.yaml:1:23: ", {"temperature of limits goes from 900 K to 250 K", "swap its ends"}},
           {"{temperature: [0 K, 250 K]}", "test.yaml:1:24: ", {"temperature of limits has an end at 0 K"}},
           {"{temperature: [10 m, 250 K]}", "test.yaml:1:24: ", {"temperature of limits has the wrong unit 'm'"}},
           {"{light: 0}", "test.yaml:1:17: ", {"light is out of range (0)", "above 0"}},
           {"{lihgt: 1}", "test.yaml:1:10: ", {"unknown key 'lihgt' in limits", "did you mean 'light'?"}},
           {"{}", "test.yaml:1:9: ", {"limits without any"}},
       }) {
    const std::string e = errorOf(limits);
    EXPECT_EQ(e.rfind(place, 0), 0u) << limits << ": " << e;
    for (const char* part : parts) EXPECT_NE(e.find(part), std::string::npos) << part << " in " << e;
  }
}

// A body counts by its bounding sphere: 990 to 1010 m here (the sphere itself to 1e-3 of its radius).
TEST(Limits, RangeIsOfTheWholeBody) {
  Simulation sim = scene(kScene);
  const WorldState state = advance(sim, 0.0);
  auto outside = [&](double nearest_m, double farthest_m) {
    sim.limits = {nearest_m, farthest_m, 0.0, 0.0, 0.0};
    return outsideLimits(sim, sim.cameras[0], state);
  };
  EXPECT_EQ(outside(1.0, 2000.0), "");
  EXPECT_EQ(outside(1.0, 990.1), "") << "partly within";
  EXPECT_EQ(outside(1.0, 989.0), "p at 990 m, planned to 989 m");
  EXPECT_EQ(outside(1009.9, 2000.0), "") << "partly within";
  EXPECT_EQ(outside(1011.0, 2000.0), "p at 1.01 km, planned from 1.011 km");
}

TEST(Limits, OnlyWhatMayBeInView) {
  Simulation sim = scene(kScene);
  sim.limits = {1.0, 500.0, 400.0, 500.0, 0.0};
  WorldState state = advance(sim, 0.0);
  EXPECT_EQ(outsideLimits(sim, sim.cameras[0], state), "p at 990 m, planned to 500 m; p at 300 K, planned from 400 K");
  state.entities[0].position = {0.0, -1000.0, 0.0};
  EXPECT_EQ(outsideLimits(sim, sim.cameras[0], state), "");
  state.entities[0].position = {0.0, 1000.0, 0.0};
  sim.cameras[0].mount.carrier = 0;
  EXPECT_EQ(outsideLimits(sim, sim.cameras[0], state), "") << "a camera does not see its carrier";
}

TEST(Limits, ManyAreCounted) {
  std::string bodies = "entities:\n";
  for (int i = 0; i < 7; ++i)
    bodies += "- {name: b" + std::to_string(i) + ", shape: {model: sphere, radius: 1 m}, material: {}, temperature: 300 K, position: [0 m, " +
              std::to_string(1000 + i) + " m, 0 m]}\n";
  Simulation sim = scene(bodies + kScene.substr(kScene.find("cameras")));
  sim.limits.nearest_m = 1.0;
  sim.limits.farthest_m = 100.0;
  const std::string text = outsideLimits(sim, sim.cameras[0], advance(sim, 0.0));
  EXPECT_NE(text.find("b3 at 1.002 km, planned to 100 m; and 3 more"), std::string::npos) << text;
  EXPECT_EQ(text.find("b4"), std::string::npos) << text;
}

}  // namespace
}  // namespace pitviper::test
