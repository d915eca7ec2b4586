// Transparent surfaces and media on the GPU against the double precision reference, which cuts each ray at every border.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr const char* kScene = R"(
atmosphere: {extinction: 20 /km, temperature: 285 K}
ambient: {temperature: 260 K}
sun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}
materials:
  pane: {transmission: {transmittance: 0.7}, components: [{reflection: lambertian, reflectance: 0.1}]}
  varied:
    transmission: {transmittance: 0.6, angular: [[0 deg, 1], [60 deg, 0.7], [90 deg, 0]], modifier: {rows: [[0.2, 1], [1, 0.5]]}}
    components: [{reflection: phong, reflectance: 0.1, exponent: 20}]
  gas: {absorption: {wavelength: um, unit: 1/m, values: [[2.9, 0.1], [4.2, 3], [5.2, 0.2]]}, radiance: 1e-3 W/(m2 sr um)}
lights: [{name: l, intensity: 40 W/(sr um), position: [5 m, 2 m, 4 m], visible: false}]
entities:
  - {name: a, shape: {model: plate, width: 10 m, height: 10 m}, material: black_gloss_paint, temperature: 310 K}
  - {name: p, shape: {model: plate, width: 2 m, height: 2 m}, material: pane, temperature: 290 K, position: [2 m, 0 m, 0 m], heading: 60 deg}
  - {name: q, shape: {model: sphere, radius: 0.6 m}, material: varied, temperature: 330 K, position: [2.5 m, -1 m, 1 m]}
  - {name: s, shape: {model: sphere, radius: 1 m}, material: gas, temperature: 400 K, position: [4 m, 1.5 m, 1 m]}
  - {name: e, shape: {model: ellipsoid, length: 4 m, width: 1 m, height: 2 m}, material: gas, temperature: 700 K, position: [0.5 m, 3 m, -1 m], heading: 30 deg}
  - {name: b, shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: gas, temperature: 400 K, position: [4 m, -2 m, 1 m], heading: 30 deg}
  - {name: c, shape: {model: cone, radius: 1 m, top_radius: 0.2 m, length: 3 m}, material: gas, temperature: 900 K, position: [4 m, 0 m, -2 m], heading: 30 deg}
  - {name: inside, shape: {model: sphere, radius: 0.3 m}, material: sand, temperature: 350 K, position: [4 m, 0.1 m, -2 m]}
  - {name: far, shape: {model: cylinder, radius: 40 m, length: 200 m}, material: gas, temperature: 500 K, position: [-2 km, 300 m, 200 m]}
cameras:
  - name: c
    film: {width: 96, height: 80}
    field_of_view: 50 deg
    aperture: 5 mm
    position: [9 m, 0 m, 0 m]
    look_at: a
    spectral: {samples: 20}
)";

std::string channels(int count) {
  std::string y = "    channels:\n";
  for (int c = 0; c < count; ++c) y += "      - {name: c" + std::to_string(c) + ", response: {band: [" + std::to_string(3.0 + 0.2 * c) + " um, 5 um]}}\n";
  return y;
}

TEST(LayersAgainstDouble, PanesAndMedia) {
  const Worst one = compare(scene(kScene + channels(1)), 3), many = compare(scene(kScene + channels(5)), 5);
  bound("panes and media, GPU float against CPU double, 20 nodes, 99 % of pixels", one.percentile99, 1e-5, "single precision");
  bound("panes and media, GPU float against CPU double, 100 nodes in 4 batches, 99 %", many.percentile99, 1e-5, "single precision");
  bound("panes and media, GPU float against CPU double, worst pixel", std::max(one.error, many.error), 1e-3,
        "a silhouette moved by 1e-5 pixel: directions in single precision");
  EXPECT_GT(one.covered, 500);
}

// Lines are walked through what they see through 262,144 at a time: those of later lots see the same air and lights as those of the first. (Lines
// of fields lie by tiles of the film, which differ here: 0.5 % in a jet's core within one lot too.)
TEST(LayersAgainstDouble, LaterLotsSeeTheSame) {
  const std::string world = R"(
atmosphere: clear_us76
sun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}
materials: {pane: {transmission: {transmittance: 0.7}, components: [{reflection: lambertian, reflectance: 0.1}]}, gas: {absorption: 0.05 /m}}
entities:
  - {name: p, shape: {model: plate, width: 60 m, height: 60 m}, material: pane, temperature: 290 K, position: [0 m, 40 m, 20 m], heading: 160 deg}
  - {name: shades, shape: {model: sphere, radius: 4 m}, material: sand, temperature: 300 K, position: [5 m, 33 m, 26 m]}
  - {name: ball, shape: {model: sphere, radius: 12 m}, material: gas, temperature: 400 K, position: [0 m, 45 m, 20 m]}
cameras:
  - {name: c, focal_length: 25 mm, aperture: 5 mm, position: [0 m, 0 m, 20 m], heading: 0 deg, spectral: {samples: 2}, channels: [{name: m, response:
      {band: [3 um, 5 um]}}], film: {pitch: 20 um, width: 640, height: )";
  constexpr std::size_t kWidth = 640, kHeight = 820, kMiddle = 200;
  const CameraImage all = renderImage(scene(world + std::to_string(kHeight) + "}}\n")), middle = renderImage(scene(world + std::to_string(kMiddle) + "}}\n"));
  ASSERT_EQ(middle.slots[0].size(), kWidth * kMiddle);
  double worst = 0.0;
  for (std::size_t p = 0; p < middle.slots[0].size(); ++p) {
    const double a = middle.slots[0][p], b = all.slots[0][p + (kHeight - kMiddle) / 2 * kWidth];
    ASSERT_TRUE(std::isfinite(b) && b > 0.0) << p;
    worst = std::max(worst, std::abs(a - b) / a);
  }
  bound("524,800 lines through a pane and gas against those of the middle rows alone, worst pixel", worst, 1e-5,
        "single precision: films begin elsewhere");
}

}  // namespace
}  // namespace pitviper::test
