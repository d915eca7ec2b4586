// Subpixels shaded as one where neighbouring pixels are alike (samples: auto): against the same picture shaded subpixel by subpixel, and against a finer one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/reader/scenario_reader.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string hills(const std::string& samples, const std::string& more = "", const std::string& entities = "") {
  return "atmosphere: hazy_us76\nsun: {azimuth: 250 deg, elevation: 25 deg, temperature: 5772 K}\nmaterials: {soil: {components: [{reflection: lambertian, "
         "reflectance: 0.3}]}, paint: {components: [{reflection: phong, reflectance: 0.3, exponent: 15}]}}\n"
         "entities:\n- {name: ground, shape: {model: terrain, size: 8 km, relief: 500 m, columns: 60, terrain_seed: 3}, material: soil, temperature: 295 K}\n"
         "- {name: jet, shape: {model: jet}, material: paint, temperature: 320 K, position: [100 m, 0 m, 700 m], heading: 60 deg}\n" +
         entities +
         "cameras: [{name: c, film: {width: 96, height: 96}, field_of_view: 6 deg, aperture: 20 mm, small_bodies: 0, position: [-500 m, -600 m, 1000 m], "
         "look_at: jet, "
         "samples: " +
         samples + ", spectral: {samples: 4}, channels: [{name: mw, response: {band: [3.6 um, 4.6 um]}}, {name: vis, response: {band: [0.5 um, 0.7 um]}}]}]\n" +
         more;
}

double relative(float a, float b) { return std::abs(static_cast<double>(a) / static_cast<double>(b) - 1.0); }

/// What is drawn over hills and jet: a column of smoke with a puff in it, and a pane across part of the picture.
std::string overThem() {
  return "- {name: smoke, shape: {model: ellipsoid, length: 40 m, width: 30 m, height: 60 m}, material: oil_smoke, temperature: 330 K, position: [40 m, -60 m, "
         "700 m]}\n"
         "- {name: puff, shape: {model: ellipsoid, length: 20 m, width: 40 m, height: 20 m}, material: oil_smoke, temperature: 330 K, position: [40 m, -50 m, "
         "715 m]}\n"
         "- {name: pane, shape: {model: plate, width: 14 m, height: 14 m}, material: acrylic_canopy, temperature: 290 K, position: [-380 m, -480 m, 930 m], "
         "heading: 20 deg}\n";
}

class SharedShading : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedShading, IsOnceOrFourTimes) {
  // Sampled evenly: one plan for all. Without an accuracy pixels are held to 1 %.
  const std::string what = GetParam(), mode = what == "direct" ? "" : "render: {mode: buffered}\n", over = what == "transparent" ? overThem() : "";
  const auto drawn = [&](const char* samples) { return renderFrame(scene(hills(samples, mode, over))); };
  const Frame shared = drawn("auto"), once = drawn("1"), four = drawn("2"), fine = drawn("8");
  size_t pixels = 0, alike = 0, asOnce = 0, farOff = 0;
  for (const char* name : {"mw.radiance", "vis.radiance"}) {
    const auto &s = layer(shared, name).pixels, &one = layer(once, name).pixels, &all = layer(four, name).pixels, &best = layer(fine, name).pixels;
    double squares = 0.0, squaresOfFour = 0.0;
    for (size_t p = 0; p < s.size(); ++p) {
      ++pixels;
      const bool lone = relative(s[p], one[p]) < 1e-4 && relative(s[p], all[p]) > 2e-7;
      alike += lone || relative(s[p], all[p]) <= 2e-7;
      asOnce += lone;
      farOff += relative(s[p], all[p]) > 0.01;
      squares += std::pow(relative(s[p], best[p]), 2.0);
      squaresOfFour += std::pow(relative(all[p], best[p]), 2.0);
    }
    bound(std::string(name) + ", root mean square off 8 x 8 by that of 2 x 2", std::sqrt(squares / squaresOfFour), 1.05, "no worse than 2 x 2");
  }
  const double all = static_cast<double>(pixels);
  std::printf("%s, shaded once: %.1f %% of pixels\n", what.c_str(), 100.0 * static_cast<double>(asOnce) / all);
  EXPECT_GT(static_cast<double>(asOnce), 0.3 * all) << "else nothing is saved";
  bound("pixels that are neither their middle nor the mean of their subpixels", 1.0 - static_cast<double>(alike) / all, 0.03,
        "middles on a neighbouring facet: a subpixel's triangle stands for the pixel's");
  bound("pixels off 2 x 2 by more than the accuracy", static_cast<double>(farOff) / all, 0.002,
        "an edge between middles that bend less than twice the accuracy");
}

INSTANTIATE_TEST_SUITE_P(Modes, SharedShading, ::testing::Values("direct", "buffered", "transparent"));

// What is even is what it is.
TEST(SharedShadingOfAWall, IsPlancksLaw) {
  const std::string wall =
      "entities: [{name: w, shape: {model: plate, width: 9 m, height: 9 m}, material: blackbody, temperature: 350 K}]\ncameras: [{name: c, film: {width: 16, "
      "height: "
      "16}, field_of_view: 1 deg, aperture: 20 mm, samples: auto, position: [20 m, 0 m, 0 m], look_at: w, channels: [{name: lw, response: {band: [8 um, 12 "
      "um]}}]}]\n";
  const Frame even = renderFrame(scene(wall));
  figure("a wall shaded once a pixel [W/(m2 sr)]", at(layer(even, "lw.radiance"), even, 3, 12), blackBodyBand(8, 12, 350), 2e-6, "Planck, single precision");
}

}  // namespace
TEST(SharedShading, IsTheDefaultWhereAnAccuracyIsAskedFor) {
  const auto read = [](const std::string& more) {
    return readScenarioText(more +
                                "cameras: [{name: c, film: {width: 4, height: 4}, aperture: 1 mm, field_of_view: 1 deg, heading: 0 deg, position: [0 m, 0 m, "
                                "0 m], channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n",
                            "test.yaml", ".", {}, {})
        .cameras.at(0);
  };
  EXPECT_TRUE(read("accuracy: 1 %\n").sharesShading);
  EXPECT_EQ(read("accuracy: 1 %\n").samples, 2);
  EXPECT_FALSE(read("accuracy: reference\n").sharesShading);
  EXPECT_EQ(read("accuracy: reference\n").samples, 2);
  for (const char* exact : {"", "accuracy: none\n"}) {
    EXPECT_FALSE(read(exact).sharesShading) << exact;
    EXPECT_EQ(read(exact).samples, 1) << exact;
  }
}

}  // namespace pitviper::test
