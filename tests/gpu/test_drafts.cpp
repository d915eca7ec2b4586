// Drafts: off by no more than they say, and the picture that was asked for takes over between two frames, the same to the byte as without them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "scenarios/commands/commands.hpp"
#include "sim/run/camera_line.hpp"
#include "sim/run/drawings_beside.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Ground, a box and a small hot body below a sky, through air with gas and a pane in it; a camera that is moved as it exposes.
constexpr const char* kScene = R"(
accuracy: 1 %
atmosphere: clear_us76
sun: {azimuth: 200 deg, elevation: 30 deg, temperature: 5772 K}
ambient: {from: sky}
time: {rate: 10 Hz, frames: 20}
materials:
  pane: {transmission: {transmittance: {wavelength: um, unit: "1", values: [[3, 0.9], [4.1, 0.9], [4.2, 0.3], [12, 0.3]]}}, components: []}
ground: {material: dry_grass, temperature: 290 K}
entities:
  - {name: hut, shape: {model: box, length: 20 m, width: 12 m, height: 9 m}, material: concrete, temperature: 300 K,
     position: [0 m, 300 m, 4.5 m], heading: 30 deg}
  - {name: hot, shape: {model: sphere, radius: 0.2 m}, material: blackbody, temperature: 700 K, position: [14 m, 300 m, 4 m]}
  - {name: window, shape: {model: plate, width: 12 m, height: 12 m}, material: pane, temperature: 295 K, position: [-12 m, 250 m, 5 m], heading: 180 deg}
cameras:
  - name: c
    film: {width: 32, height: 30, pitch: 20 um}
    field_of_view: 9 deg
    aperture: 40 mm
    samples: 2
    position: [0 m, 0 m, 6 m]
    look_at: [0 m, 300 m, 6 m]
    channels:
      - {name: mw, response: {band: [3.6 um, 4.9 um]}}
      - {name: lw, response: {band: [8 um, 11 um]}}
)";

CameraImage drawn(CameraLine& line, const Simulation& sim, double time_s) {
  line.begin([&sim](double t) { return advance(sim, t); }, time_s);
  return line.finish();
}

void waitFor(const DrawingsBeside& beside) {
  while (!beside.isReady()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

TEST(Drafts, SayWhatTheyAreOffByAndGiveWay) {
  needContext();
  const Simulation sim = scene(kScene);
  const Camera& camera = sim.cameras[0];
  const auto gpu = std::make_shared<const GpuScene>(sim);
  CameraLine asked(sim, camera, shaderLibrary(), gpu, {}), line(sim, camera, shaderLibrary(), gpu, {}, false, true);
  EXPECT_TRUE(line.isDraft());
  EXPECT_FALSE(asked.isDraft());
  EXPECT_FALSE(hasDraft(sim, camera)) << "its plan is known by now";
  const CameraImage draft = drawn(line, sim, 0.0), exact = drawn(asked, sim, 0.0);
  EXPECT_TRUE(draft.isDraft);
  EXPECT_EQ(draft.accuracy, kDraft);
  EXPECT_NE(draft.plan, exact.plan);
  ASSERT_EQ(draft.predictedError.size(), exact.predictedError.size());
  for (size_t s = 0; s < exact.slots.size(); ++s) {
    const double brightest = *std::max_element(exact.slots[s].begin(), exact.slots[s].end());
    std::vector<double> errors;
    for (size_t p = 0; p < exact.slots[s].size(); ++p)
      errors.push_back(std::abs(draft.slots[s][p] - exact.slots[s][p]) / std::max(exact.slots[s][p], 1e-3 * brightest));
    std::sort(errors.begin(), errors.end());
    const std::string of = " of a draft, slot " + std::to_string(s);
    bound("error in 99 of 100 pixels" + of, errors[errors.size() * 99 / 100], kDraft, "what a draft may be off by");
    bound("largest error" + of, errors.back(), draft.predictedError[s] + exact.predictedError[s], "what it and the picture it is held against predict");
    EXPECT_LE(draft.predictedError[s], kDraft);
  }
  DrawingsBeside beside(sim, shaderLibrary(), {0}, DrawingsBeside::Which::First, 0.0);
  for (int k = 0; k < 5; ++k) drawn(line, sim, 0.1 * k);  // drafts are drawn meanwhile
  waitFor(beside);
  auto made = beside.take();
  ASSERT_EQ(made.size(), 1u) << beside.why();
  ASSERT_EQ(made[0].work_ns.size(), 1u);
  EXPECT_GT(made[0].work_ns[0], 0.0);
  line.takeOver(std::move(made[0].drawing));
  EXPECT_FALSE(line.isDraft());
  for (double time_s : {0.0, 1.3}) {
    const CameraImage after = drawn(line, sim, time_s), same = drawn(asked, sim, time_s);
    EXPECT_FALSE(after.isDraft);
    EXPECT_EQ(after.plan, same.plan);
    EXPECT_EQ(after.slots, same.slots);
  }
}

TEST(Drafts, GoOnWhereTheDriverRefuses) {
  needContext();
  const Simulation sim = scene(kScene);
  const auto gpu = std::make_shared<const GpuScene>(sim);
  CameraLine line(sim, sim.cameras[0], shaderLibrary(), gpu, {}, false, true);
  const char* before = std::getenv("PITVIPER_GL");
  const std::string kept = before ? before : "";
  setenv("PITVIPER_GL", "device:999", 1);
  DrawingsBeside beside(sim, shaderLibrary(), {0}, DrawingsBeside::Which::First, 0.0);
  waitFor(beside);
  before ? setenv("PITVIPER_GL", kept.c_str(), 1) : unsetenv("PITVIPER_GL");
  EXPECT_TRUE(beside.take().empty());
  EXPECT_NE(beside.why().find("device:999"), std::string::npos) << beside.why();
  EXPECT_TRUE(drawn(line, sim, 0.0).isDraft);
}

TEST(Drafts, EndWhileWhatWasAskedForIsBeingMade) {
  needContext();
  Simulation sim = scene(kScene);
  sim.cameras[0].spectral.accuracy = 0.0125;  // a plan that no cache has
  const auto gpu = std::make_shared<const GpuScene>(sim);
  CameraLine line(sim, sim.cameras[0], shaderLibrary(), gpu, {}, false, true);
  { const DrawingsBeside beside(sim, shaderLibrary(), {0}, DrawingsBeside::Which::AllRungs, 0.0); }
  EXPECT_TRUE(drawn(line, sim, 0.0).isDraft);
}

}  // namespace
}  // namespace pitviper::test
