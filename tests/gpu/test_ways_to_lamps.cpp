// What layered air holds on the way from a lit surface to a lamp, as the GPU adds it up from densities by height, against the double precision of the models'
// own integral: plates lit by a lamp alone, in fog that ends somewhere between them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(WaysToLamps, HoldWhatTheModelsHold) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) { return low + (high - low) * std::uniform_real_distribution<>()(random); };
  double worst = 0.0, farthest = 0.0;
  for (int n = 0; n < 60; ++n) {
    const double visibility_km = 0.7 * std::pow(30.0, between(0.0, 1.0)), height_m = between(100.0, 3500.0);
    // Near by, or far up, where there is less and less air.
    const double way_m = 20.0 * std::pow(1000.0, between(0.0, 1.0)), rise = way_m > 500.0 * visibility_km ? between(0.7, 3.0) : between(-0.3, 1.0);
    const double up_m = std::max(rise * way_m, 10.0 - height_m), aside_m = 0.5 * way_m;
    char text[1500];
    std::snprintf(text, sizeof text,
                  "background: {temperature: 3 K}\naccuracy: 1 %%\natmosphere: {library: hazy_us76, visibility: %.6g km}\n"
                  "entities: [{name: p, shape: {model: plate, width: 10 m, height: 10 m}, material: white_lambertian, temperature: 200 K, position: [0 m, 0 m, "
                  "%.6g m], heading: 180 deg}]\n"
                  "lights: [{name: l, intensity: {blackbody: 2500 K, area: %.6g m2}, position: [%.6g m, %.6g m, %.6g m], visible: false}]\n"
                  "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 20 deg, aperture: 5 mm, near: 0.1 m, position: [0 m, -3 m, %.6g m], "
                  "look_at: p, channels: [{name: v, response: {band: [0.5 um, 0.55 um]}}]}]\n",
                  visibility_km, height_m, way_m * way_m, aside_m, -way_m, height_m + up_m, height_m);
    const Worst w = compare(scene(text), 1);
    EXPECT_GT(w.covered, 10) << "lit, scene " << n;
    worst = std::max(worst, w.error);
    farthest = std::max(farthest, up_m);
  }
  EXPECT_GT(farthest, 20e3);
  bound("surfaces lit by lamps through fog and above it, GPU against double", worst, 2e-3, "columns between heights, in three pieces");
}

}  // namespace
}  // namespace pitviper::test
