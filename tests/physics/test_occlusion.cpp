// What is smaller than a pixel is hidden by what stands in front of it, large or small, wholly or in part.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string camera(const std::string& position, const std::string& more) {
  return "cameras:\n  - {name: c, film: {width: 33, height: 33}, field_of_view: 2 deg, aperture: 20 mm, position: " + position + ", " + more +
         ", channels: [{name: mw, response: {band: [3 um, 5 um]}}]}\n";
}

/// Sum of radiance x solid angle x range^2 [W/sr] over a black background.
double intensity(const Simulation& sim, double range) {
  const CameraImage image = renderImage(sim);
  double total = 0.0;
  for (size_t p = 0; p < image.slots[0].size(); ++p) total += image.slots[0][p] * image.solidAngles->plain_sr[p];
  return total * range * range;
}

TEST(Occlusion, ABodyInsideASmallBodyIsNotSeen) {
  for (double range : {300.0, 5000.0, 200000.0}) {
    const auto sim = scene(
        "entities:\n  - {name: shell, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K}\n"
        "  - {name: core, shape: {model: sphere, radius: 0.5 m}, material: blackbody, temperature: 1000 K}\n" +
        camera("[" + std::to_string(range) + " m, 0 m, 0 m]", "look_at: shell"));
    figure("hot sphere inside a 300 K sphere, " + std::to_string(static_cast<int>(range)) + " m [W/sr]", intensity(sim, range), blackBodyBand(3, 5, 300) * kPi,
           3e-3, "outer sphere's L pi r2; silhouette");
  }
}

TEST(Occlusion, SmallBehindSmall) {
  const std::string plates =
      "entities:\n  - {name: cold, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: 0 K}\n"
      "  - {name: hot, shape: {model: sphere, radius: 0.5 m}, material: blackbody, temperature: 1000 K, position: [";
  EXPECT_EQ(intensity(scene(plates + "-5 m, 0 m, 0 m]}\n" + camera("[10000 m, 0 m, 0 m]", "look_at: cold")), 1e4), 0.0);
  figure("hot sphere before a cold plate, 10 km [W/sr]",
         intensity(scene(plates + "5 m, 0 m, 0 m]}\n" + camera("[10000 m, 0 m, 0 m]", "look_at: cold")), 9995.0), blackBodyBand(3, 5, 1000) * kPi * 0.25, 3e-3,
         "L pi r2; silhouette");
}

// Two plates beside each other in one pixel, and half over each other.
TEST(Occlusion, SmallBesideSmall) {
  auto scene2 = [](double shift, double depth) {
    return scene(
        "entities:\n  - {name: a, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 600 K}\n  - {name: b, shape: {model: "
        "plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 600 K, position: [" +
        std::to_string(depth) + " m, " + std::to_string(shift) + " m, 0 m]}\n" + camera("[4000 m, 0 m, 0 m]", "heading: 270 deg"));
  };
  figure("two plates side by side in a pixel [W/sr]", intensity(scene2(1.0, 2.0), 4000.0), 2.0 * blackBodyBand(3, 5, 600), 3e-3,
         "L A; ranges 4000 and 3998 m (5e-4), silhouette");
  figure("two plates half over each other [W/sr]", intensity(scene2(0.5, 2.0), 4000.0), 1.5 * blackBodyBand(3, 5, 600), 3e-3, "L A of the union");
}

// Standing on ground seen obliquely: no flicker as the camera turns by fractions of a pixel.
TEST(Occlusion, OnTheGround) {
  const double ifov = 2.0 * std::tan(kPi / 180.0) / 33.0, range = std::hypot(5000.0, 200.0), depression = std::atan2(199.0, 5000.0);
  double worst = 0.0, worstLamp = 0.0;
  for (int phase = 0; phase < 8; ++phase) {
    const std::string pitch = std::to_string(-depression + (phase / 8.0 - 0.5) * ifov);
    const std::string ground =
        "  - {name: ground, shape: {model: plate, width: 60 km, height: 60 km}, material: blackbody, temperature: 0 K, heading: 0 deg, pitch: 90 deg}\n";
    const std::string cam = camera("[5000 m, 0 m, 200 m]", "heading: 270 deg, pitch: " + pitch + " rad");
    const auto body = scene(
        "entities:\n  - {name: s, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 600 K, position: [0 m, 0 m, 1 m]}\n" + ground + cam);
    worst = std::max(worst, std::abs(intensity(body, range) / (blackBodyBand(3, 5, 600) * kPi) - 1.0));
    const auto lamp = scene("lights: [{name: l, intensity: 100 W/(sr um), position: [0 m, 0 m, 1 m]}]\nentities:\n" + ground + cam);
    worstLamp = std::max(worstLamp, std::abs(intensity(lamp, range) / 200.0 - 1.0));
  }
  bound("sphere on oblique ground, 8 phases of a pixel, worst error", worst, 3e-3, "silhouette on 256 x 256; range to 2e-4");
  bound("lamp above oblique ground, 8 phases of a pixel, worst error", worstLamp, 1e-3, "its own line of sight; range to 2e-4");
}

TEST(Occlusion, ALampBehindASmallPlateIsDark) {
  const auto sim = scene(
      "lights: [{name: l, intensity: 100 W/(sr um), position: [-5 m, 0 m, 0 m]}]\n"
      "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: 0 K}]\n" +
      camera("[400 m, 0 m, 0 m]", "look_at: p"));
  EXPECT_EQ(intensity(sim, 1.0), 0.0);
}

// Inside a body drawn by its zoomed view pixels have the body's own radiance.
TEST(Occlusion, InteriorIsFlat) {
  const double ifov = 2.0 * std::tan(kPi / 180.0) / 33.0;
  const auto sim = scene("entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 400 K}]\n" +
                         camera("[" + std::to_string(1.0 / (9.0 * ifov)) + " m, 0 m, 0 m]", "heading: 270 deg"));
  const CameraImage image = renderImage(sim);
  double worst = 0.0, highest = 0.0;
  for (int y = 13; y <= 19; ++y)
    for (int x = 13; x <= 19; ++x) worst = std::max(worst, std::abs(image.slots[0][static_cast<size_t>(33 * y + x)] / blackBodyBand(3, 5, 400) - 1.0));
  for (double v : image.slots[0]) highest = std::max(highest, v);
  bound("interior of a plate of 9 pixels, worst error", worst, 1e-5, "single precision");
  bound("brightest pixel of it over the plate's radiance, less 1", highest / blackBodyBand(3, 5, 400) - 1.0, 1e-5, "nothing is brighter than its source");
}

}  // namespace
}  // namespace pitviper::test
