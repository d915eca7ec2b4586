// What moves while a film is exposed, at once or row by row.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/camera/exposure_parts.hpp"
#include "sim/model/stage.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A hot plate of 4 x 60 pixels that moves by `px_per_s` to the right; a pixel is 0.15 m. At t = 0 its left edge is in the film's middle.
Simulation moving(double px_per_s, const std::string& camera, const std::string& time = "time: {rate: 50 Hz, frames: 3}\n") {
  const double v = 0.15 * px_per_s;
  return scene(
      time +
      print("background: {temperature: 3 K}\nmaterials: {m: {components: []}}\nentities: [{name: p, shape: {model: plate, width: 0.6 m, height: 9 m}, "
            "material: m, "
            "temperature: 400 K, motion: [{time: -1 s, position: [1000 m, %.9g m, 0 m], heading: 270 deg}, {time: 1 s, position: [1000 m, %.9g m, 0 m], "
            "heading: 270 deg}]}]\n",
            -0.3 + v, -0.3 - v) +
      "cameras: [{name: c, film: {width: 64, height: 48, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, samples: 8, small_bodies: 0, position: [0 m, 0 "
      "m, 0 m], heading: "
      "90 deg, " +
      camera + "}]\n");
}

/// Of a scenario's own world.
ExposureParts partsOf(const Simulation& sim, double time_s) {
  return exposureParts(sim, sim.cameras[0], [&sim](double t) { return advance(sim, t); }, time_s);
}

const char* const kRadiance = "channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]";

// A bar of 4 pixels that moves by 20 during the exposure: a trapezoid of a fifth of its light, its ends four pixels long.
TEST(ExposureParts, AMovingBarIsATrapezoid) {
  const Simulation sim = moving(2000.0, std::string("exposure: 10 ms, motion_blur: true, ") + kRadiance);
  const ExposureParts parts = partsOf(sim, 0.0);
  EXPECT_GE(parts.times_s.size(), 23u) << "sqrt(20 / 0.04)";
  bound("expected error of its parts", parts.error, 0.01, "1 % where no accuracy is asked for");
  EXPECT_NEAR(parts.motion_px, 20.0, 0.1);
  const Frame f = renderFrame(sim);
  const double whole = blackBodyBand(3.6, 4.9, 400.0);
  // Its left edge goes from -10 to 10 pixels off the middle: the mean of boxes, averaged over a pixel.
  const auto covered = [](double x) {  // integral of the trapezoid up to x, from its left end
    const auto ramp = [](double u) { return u <= 0.0 ? 0.0 : u * u / 2.0; };
    return (ramp(x + 10.0) - ramp(x + 6.0) - ramp(x - 10.0) + ramp(x - 14.0)) / 20.0;
  };
  double worst = 0.0, sum = 0.0;
  for (int c = 0; c < 64; ++c) {
    const double found = at(layer(f, "mw.radiance"), f, c, 24) / whole;
    sum += found;
    worst = std::max(worst, std::abs(found - (covered(c - 31.0) - covered(c - 32.0))));
  }
  bound("a bar that moves by 20 pixels against its closed form, of its contrast", worst, 0.012, "1 % expected of 23 parts; edges on 8 subpixels");
  figure("its light, in pixels", sum, 4.0, 2e-3, "nothing is lost");
}

TEST(ExposureParts, StillThingsTakeOne) {
  const Simulation sim = moving(0.0, std::string("exposure: 10 ms, motion_blur: true, ") + kRadiance);
  EXPECT_EQ(partsOf(sim, 0.0).times_s.size(), 1u);
  const Simulation off = moving(2000.0, std::string("exposure: 10 ms, ") + kRadiance);
  EXPECT_EQ(partsOf(off, 0.0).times_s.size(), 1u) << "nobody asked for it";
  const Simulation own = moving(2000.0, std::string("exposure: 10 ms, motion_blur: true, exposure_parts: 5, ") + kRadiance);
  EXPECT_EQ(partsOf(own, 0.0).times_s.size(), 5u);
}

// Rolling read-out: a row of y pixels below the middle sees the bar where it is y line times later.
TEST(ExposureParts, RollingReadOutSlantsWhatMoves) {
  const double speed = 1000.0, line_s = 2e-4;  // 0.2 pixels a row
  const Simulation sim =
      moving(speed,
             "exposure: 1 ms, stages: [{stage: detector, full_well: 1e7, line_time: 0.2 ms}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, "
             "quantum_efficiency: 0.8, output: electrons}]");
  const Frame f = renderFrame(sim);
  double worst = 0.0;
  for (int row = 2; row < 46; ++row) {
    double sum = 0.0, moment = 0.0;
    for (int c = 0; c < 64; ++c) {
      const double v = at(layer(f, "mw.electrons"), f, c, row);
      sum += v, moment += v * (c + 0.5);
    }
    if (sum > 0.0) worst = std::max(worst, std::abs(moment / sum - (34.0 + speed * line_s * (row - 23.5))));
  }
  bound("middle of a moving bar in each row, pixels off the row's own time", worst, 0.0625, "edges on 8 subpixels are up to a sixteenth off");
  const Simulation blurred =
      moving(speed,
             "exposure: 4 ms, motion_blur: true, stages: [{stage: detector, full_well: 1e7, line_time: 0.2 ms}], channels: [{name: mw, response: {band: "
             "[3.6 um, 4.9 um]}, quantum_efficiency: 0.8, output: electrons}]");
  const Frame g = renderFrame(blurred);
  worst = 0.0;
  double widest = 0.0;
  for (int row = 2; row < 46; ++row) {
    double sum = 0.0, moment = 0.0, square = 0.0;
    for (int c = 0; c < 64; ++c) {
      const double v = at(layer(g, "mw.electrons"), g, c, row);
      sum += v, moment += v * (c + 0.5), square += v * (c + 0.5) * (c + 0.5);
    }
    const double middle = moment / sum;
    worst = std::max(worst, std::abs(middle - (34.0 + speed * line_s * (row - 23.5))));
    widest = std::max(widest, std::abs(square / sum - middle * middle - (16.0 + 16.0 + 1.0) / 12.0));
  }
  bound("the same while it is exposed for 4 ms, pixels off", worst, 0.15, "an exposure's ends lie within parts");
  bound("its variance off that of bar, motion and pixel [pixels^2]", widest, 0.2, "(4^2 + 4^2 + 1) / 12");
}

// Times around a frame's own are drawn by what is there then; a lamp that crosses leaves its light along its way.
TEST(ExposureParts, ALampLeavesAStreak) {
  const auto flux = [](const std::string& blur) {
    const Frame f =
        renderFrame(scene("time: {rate: 50 Hz, frames: 3}\nbackground: {temperature: 3 K}\nlights: [{name: l, intensity: {wavelength: um, unit: W/(sr um), "
                          "values: [[3, 1], [5, 1]]}, motion: [{time: -1 s, "
                          "position: [1000 m, 150 m, 0.1 m]}, {time: 1 s, position: [1000 m, -150 m, 0.1 m]}]}]\ncameras: [{name: c, film: {width: 64, height: "
                          "48, pitch: 15 um}, focal_length: 100 mm, "
                          "aperture: 25 mm, exposure: 10 ms, " +
                          blur +
                          "stages: [{stage: point_spread, beyond: 0.01}], position: [0 m, 0 m, 0 m], heading: 90 deg, channels: [{name: mw, response: {band: "
                          "[3.6 um, 4.9 um]}, output: flux}]}]\n"));
    return std::pair{sum(layer(f, "mw.flux")), at(layer(f, "mw.flux"), f, 32, 23)};
  };
  const auto [still, peak] = flux("");
  const auto [streak, along] = flux("motion_blur: true, exposure_parts: 64, ");
  figure("light of a lamp that moves by ten pixels, of the same at rest", streak, still, 2e-3, "energy");
  const Simulation lamp = scene(
      "time: {rate: 50 Hz, frames: 3}\nbackground: {temperature: 3 K}\nlights: [{name: l, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 1], [5, "
      "1]]}, motion: [{time: -1 s, position: [1000 m, 150 m, "
      "0.1 m]}, {time: 1 s, position: [1000 m, -150 m, 0.1 m]}]}]\ncameras: [{name: c, film: {width: 64, height: 48, pitch: 15 um}, focal_length: 100 mm, "
      "aperture: 25 mm, exposure: 10 ms, motion_blur: true, "
      "position: [0 m, 0 m, 0 m], heading: 90 deg, channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, output: flux}]}]\n");
  const ExposureParts parts = partsOf(lamp, 0.0);
  EXPECT_GE(parts.times_s.size(), 40u) << "four a pixel of ten";
  EXPECT_NEAR(parts.streakError, 0.25, 0.01);
  EXPECT_LT(along, 0.25 * peak) << "it is on ten pixels";
  EXPECT_GT(along, 0.05 * peak);
}

}  // namespace
}  // namespace pitviper::test
