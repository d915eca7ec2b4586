// Frames that audit themselves: what is looked at, what is found, and what comes of it.
#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/audit.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/plan_origin.hpp"
#include "sim/plan/planner.hpp"
#include "sim/run/run.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Ground, a box, a body of less than a pixel, a pane, a gas and a lamp in view, in sunlit air.
constexpr const char* kScene = R"(
atmosphere: clear_us76
sun: {azimuth: 200 deg, elevation: 30 deg, temperature: 5772 K}
ambient: {from: sky}
time: {rate: 1 Hz, frames: 40}
materials:
  pane: {transmission: {transmittance: {wavelength: um, unit: "1", values: [[3, 0.9], [4.1, 0.9], [4.2, 0.3], [12, 0.3]]}}, components: []}
  gas: {absorption: {wavelength: um, unit: 1/m, values: [[3, 0.01], [4.2, 0.01], [4.3, 0.5], [4.5, 0.5], [4.6, 0.01], [12, 0.01]]}}
entities:
  - {name: ground, shape: {model: plate, width: 4 km, height: 4 km}, pitch: 90 deg, material: dry_grass, temperature: 290 K}
  - {name: hut, shape: {model: box, length: 20 m, width: 12 m, height: 9 m}, material: concrete, temperature: 300 K,
     position: [0 m, 300 m, 4.5 m], heading: 30 deg}
  - {name: hot, shape: {model: sphere, radius: 0.2 m}, material: blackbody, temperature: 700 K, position: [14 m, 300 m, 4 m]}
  - {name: window, shape: {model: plate, width: 12 m, height: 12 m}, material: pane, temperature: 295 K, position: [-12 m, 250 m, 5 m], heading: 180 deg}
  - {name: cloud, shape: {model: sphere, radius: 5 m}, material: gas, temperature: 600 K, position: [12 m, 260 m, 8 m]}
lights:
  - {name: lamp, intensity: {blackbody: 2500 K, area: 4 cm2}, position: [-4 m, 280 m, 11 m]}
cameras:
  - name: c
    film: {width: 24, height: 20, pitch: 20 um}
    field_of_view: 8 deg
    aperture: 40 mm
    samples: 2
    position: [0 m, 0 m, 6 m]
    look_at: [0 m, 300 m, 6 m]
    channels:
      - {name: mw, response: {band: [3.6 um, 4.9 um]}}
      - {name: lw, response: {band: [8 um, 11 um]}}
)";

TEST(Audit, OneInTenMeansEveryTenthFrame) {
  int looked = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const int pixels = auditedPixels(0.1, frame);
    EXPECT_EQ(pixels, frame % 10 == 0 ? 1 : 0) << frame;
    looked += pixels;
  }
  EXPECT_EQ(looked, 10);
  EXPECT_EQ(auditedPixels(3.0, 17), 3);
  EXPECT_EQ(auditedPixels(0.0, 0), 0);
  EXPECT_EQ(auditedPixels(1.5, 0) + auditedPixels(1.5, 1), 3);
}

// The pixels that are wanted are those of the whole reference picture, small bodies and lamps in them included.
TEST(Audit, WantedPixelsAreThoseOfTheWholePicture) {
  needContext();
  // Which pixels are drawn is no matter of wavelengths: few, the bend of the gas among them.
  std::string text = kScene;
  for (const auto& [wide, narrow] : {std::pair<std::string, const char*>{"[3.6 um, 4.9 um]", "[4.2 um, 4.3 um]"}, {"[8 um, 11 um]", "[9.5 um, 9.7 um]"}})
    text.replace(text.find(wide), wide.size(), narrow);
  Simulation sim = scene(text);
  sim.cameras[0].spectral = {};
  sim.cameras[0].spectral.reference = true;
  const auto gpu = std::make_shared<const GpuScene>(sim);
  const WorldState state = advance(sim, 0.0);
  CameraRenderer renderer(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), gpu);
  const CameraImage whole = renderer.render(state);
  std::vector<int> wanted;
  for (int p = 0; p < 24 * 20; p += 7) wanted.push_back(p);
  renderer.setWanted(wanted);
  const CameraImage some = renderer.render(state);
  double worst = 0.0;
  for (int p : wanted)
    for (size_t s = 0; s < whole.slots.size(); ++s)
      worst = std::max(worst, std::abs(some.slots[s][static_cast<size_t>(p)] / whole.slots[s][static_cast<size_t>(p)] - 1.0));
  // A zoomed view's samples are linear between others where they may be: which, depends on what is wanted.
  bound("pixels wanted alone against the whole reference picture", worst, 1e-4, "samples between others: 2e-5 each");
}

TEST(Audit, FindsWhatAPlanIsOffBy) {
  needContext();
  Simulation sim = scene(std::string(kScene) + "accuracy: 1 %\naudit: 12\n");
  const Plan good = planFor(sim, {&sim.cameras[0], nullptr});
  const RunReport kept = runFrames(sim, shaderLibrary(), {0, 1}, [](const auto&) {});
  EXPECT_TRUE(kept.broken.empty());
  ASSERT_EQ(kept.audits.count("c"), 1u);
  EXPECT_EQ(kept.audits.at("c").pixels, 24);
  bound("audit of a plan that holds, 24 pixels, largest of what was asked", kept.audits.at("c").largest / 0.01, 1.0, "asked for");

  // A plan that gives everything 5 % too much, as another run might have left it.
  Plan bad = good;
  for (auto& row : bad.weight)
    for (double& w : row) w *= 1.05;
  sim.cameras[0].plan = originLine(originOf(sim, sim.cameras[0])) + writePlanned(bad);
  sim.cameras[0].planFile = "c.plan";
  int drawn = 0;
  const RunReport broken = runFrames(
      sim, shaderLibrary(), {0, 9}, [&](const auto&) { ++drawn; }, {}, {}, true);
  EXPECT_EQ(drawn, 1) << "it stops where it is found";
  EXPECT_FALSE(broken.broken.empty());
  EXPECT_NEAR(broken.audits.at("c").largest, 0.05, 0.011) << "5 %, and what the good plan may be off by";
}

// A frame does not depend on which others are drawn: neither its pixels nor what its audit says.
TEST(Audit, TheSameWhicheverFramesAreDrawn) {
  needContext();
  const Simulation sim = scene(std::string(kScene) + "accuracy: 1 %\naudit: 0.5\n");
  const auto framesOf = [&](RunRange range) {
    std::map<int, Frame> frames;
    runFrames(sim, shaderLibrary(), range, [&](const auto& f) { frames[f->number] = *f; });
    return frames;
  };
  const auto many = framesOf({0, 4}), few = framesOf({3, 4});
  for (int number : {3, 4}) {
    const Frame &a = many.at(number), &b = few.at(number);
    ASSERT_EQ(a.attributes.size(), b.attributes.size());
    for (size_t k = 0; k < a.attributes.size(); ++k) {
      if (a.attributes[k].name.starts_with("entity.")) continue;  // what is out of view has no place: not a number
      EXPECT_EQ(a.attributes[k].value, b.attributes[k].value) << a.attributes[k].name;
    }
    for (size_t l = 0; l < a.layers.size(); ++l) EXPECT_EQ(a.layers[l].pixels, b.layers[l].pixels);
  }
}

TEST(Audit, APlanOfSomethingElseIsRefused) {
  Simulation sim = scene(std::string(kScene) + "accuracy: 1 %\n");
  sim.cameras[0].plan = "pitviper plan 3 1 1\nnonsense\n";
  sim.cameras[0].planFile = "c.plan";
  EXPECT_THROW(planFor(sim, {&sim.cameras[0], nullptr}), UserError);
}

}  // namespace
}  // namespace pitviper::test
