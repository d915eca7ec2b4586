// What is transparent, drawn in its part of a picture and laid over the direct pass' picture of the rest, against all of it drawn in buffered mode.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/camera/overlay.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string world(const std::string& samples) {
  return R"(
time: {frames: 1, rate: 1 Hz}
atmosphere: {extinction: 0.4 /km, temperature: 285 K}
ambient: {temperature: 260 K}
sun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}
entities:
  - {name: a, shape: {model: sphere, radius: 1 m}, material: black_gloss_paint, temperature: 310 K, position: [0 m, 3 m, 1 m]}
  - {name: plume, shape: {model: sphere, radius: 0.5 m}, material: afterburner_plume, temperature: 900 K, position: [0 m, -1.5 m, 2 m]}
  - {name: behind, shape: {model: sphere, radius: 0.5 m}, material: sand, temperature: 350 K, position: [-3 m, -2 m, 2 m]}
  - {name: small, shape: {model: sphere, radius: 0.02 m}, material: sand, temperature: 500 K, position: [-4 m, -2.1 m, 2.3 m]}
  - {name: far, shape: {model: sphere, radius: 0.02 m}, material: sand, temperature: 500 K, position: [-4 m, 3 m, -2 m]}
plumes: [{name: exhaust, nozzles: [[0 m, -2.5 m, 1 m]], direction: [0, 1, 0.3], engine: turboshaft, length: 2 m}]
cameras:
  - name: c
    film: {width: 56, height: 48}
    field_of_view: 40 deg
    aperture: 5 mm
    position: [12 m, 0 m, 1 m]
    look_at: [0 m, 0 m, 1 m]
    samples: )" +
         samples + R"(
    truth: [range, entity, normal, temperature]
    spectral: {samples: 16}
    channels:
      - {name: mid, response: {band: [3 um, 5 um]}}
      - {name: long, response: {band: [8 um, 10 um]}}
)";
}

double worstDifference(const std::string& samples) {
  // Few lines through what is small: both ways have the same.
  const auto drawn = [&](const std::string& mode) {
    Simulation sim = scene(world(samples) + mode);
    sim.cameras[0].zoomedSamples = 32;
    return sim;
  };
  const Simulation sim = drawn("");
  const Camera& camera = sim.cameras[0];
  const WorldState state = advance(sim, 0.0);
  View view = cameraView(camera, state, camera.samples);
  view.subpixels = camera.samples;
  const auto overlay = overlayIn(sim, state, view, std::vector<char>(sim.entities.size(), 1));
  EXPECT_TRUE(overlay && !overlay->isEmpty()) << "it is drawn in two parts";
  EXPECT_TRUE(sim.mode == RenderMode::Auto);
  const Frame parts = renderFrame(sim), whole = renderFrame(drawn("render: {mode: buffered}\n"));
  double worst = 0.0;
  for (size_t l = 0; l < whole.layers.size(); ++l)
    for (size_t p = 0; p < whole.layers[l].pixels.size(); ++p) {
      const double a = static_cast<double>(whole.layers[l].pixels[p]), b = static_cast<double>(parts.layers[l].pixels[p]);
      EXPECT_TRUE(std::isfinite(b));
      if (a != b) worst = std::max(worst, std::abs(a - b) / std::max(std::abs(a), 1e-30));
    }
  return worst;
}

// Rationale: a body of gas, a jet before a body, what is small before, behind and beside them; whole pixels, subpixels, and those that share their shading.
TEST(Overlay, EqualsBufferedMode) {
  for (const char* samples : {"1", "3", "auto"})
    bound(std::string("direct with an overlay against buffered, samples ") + samples, worstDifference(samples), 1e-4,
          "lines of fields lie on a film of another corner, in single precision");
}

// Rationale: passes keep a target of each size that they ever drew, and an hour of a stream must not have thousands.
TEST(Overlay, HasFewSizes) {
  const Simulation sim = scene(world("1"));
  const WorldState state = advance(sim, 0.0);
  for (double closer : {1.0, 1.1, 1.2, 1.3, 1.4}) {
    View view = cameraView(sim.cameras[0], state, 1);
    view.width = view.height = 400;
    view.axisX = view.axisY = 200.0;
    view.tanPerPixelX /= closer, view.tanPerPixelY /= closer;
    const auto overlay = overlayIn(sim, state, view, std::vector<char>(sim.entities.size(), 1));
    ASSERT_TRUE(overlay);
    for (int k = 0; k < 2; ++k) {
      const int size = overlay->drawn[k + 2];
      EXPECT_EQ(size & (size - 1), 0) << size;
      EXPECT_LE(overlay->drawn[k], overlay->counts[k]);
      EXPECT_GE(overlay->drawn[k] + size, overlay->counts[k] + overlay->counts[k + 2]);
    }
  }
}

// Rationale: what covers the picture leaves nothing to the direct pass; where nothing shows there is nothing to lay.
TEST(Overlay, IsNoMoreThanItNeeds) {
  const Simulation sim = scene(world("1"));
  const WorldState state = advance(sim, 0.0);
  View view = cameraView(sim.cameras[0], state, 1);
  std::vector<char> none(sim.entities.size(), 0);
  view.localFromCamera = view.localFromCamera * glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1);
  const auto away = overlayIn(sim, state, view, none);
  ASSERT_TRUE(away);
  EXPECT_TRUE(away->isEmpty());
  view = cameraView(sim.cameras[0], state, 1);
  view.tanPerPixelX *= 0.05, view.tanPerPixelY *= 0.05;
  view.position = glm::dvec3(1.0, -1.5, 2.0);
  EXPECT_FALSE(overlayIn(sim, state, view, std::vector<char>(sim.entities.size(), 1)));
}

}  // namespace
}  // namespace pitviper::test
