// Layered air on the GPU, which reads tables made for a view, against the reference pixel in double precision, which integrates along each ray.
#include <gtest/gtest.h>

#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string channels(double low, double high) {
  return "channels: [{name: a, response: {band: [" + std::to_string(low) + " um, " + std::to_string(high) + " um]}}]";
}

// Ground, bodies near and far, sky; looking down, level and up; with and without sun and lights.
TEST(LayeredAir, TablesAgainstRays) {
  double worst = 0.0;
  for (const auto& [low, high] : {std::pair{0.5, 0.7}, {3.6, 4.9}, {8.0, 12.0}})
    for (const double height : {300.0, 6000.0})
      for (const char* mode : {"direct", "buffered"}) {
        const auto sim = scene(
            "atmosphere: hazy_us76\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nambient: {from: sky}\nrender: {mode: " + std::string(mode) +
            "}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.35}]}}\n"
            "lights: [{name: l, intensity: {blackbody: 2500 K, area: 1 m2}, position: [0 m, 5 km, 800 m], visible: false}]\n"
            "entities:\n  - {name: ground, shape: {model: plate, width: 80 km, height: 80 km}, material: m, temperature: 290 K, pitch: 90 deg}\n"
            "  - {name: near, shape: {model: sphere, radius: 10 m}, material: m, temperature: 320 K, position: [0 m, 150 m, " +
            std::to_string(height) +
            " m]}\n"
            "  - {name: far, shape: {model: sphere, radius: 900 m}, material: m, temperature: 270 K, position: [2 km, 25 km, 7 km]}\n"
            "cameras: [{name: c, film: {width: 48, height: 48}, field_of_view: 40 deg, aperture: 5 mm, position: [0 m, 0 m, " +
            std::to_string(height) + " m], look_at: [0 m, 10 km, 2 km], " + channels(low, high) + "}]\n");
        const Worst w = compare(sim, 3);
        EXPECT_GT(w.covered, 200);
        worst = std::max(worst, w.error);
      }
  bound("layered air by tables against rays, 0.1 to 60 km, worst pixel", worst, 5e-3,
        "elevations as many as 1 % needs, 96 ranges, linear between: curvature of the sky and of ln density");
}

}  // namespace
}  // namespace pitviper::test
