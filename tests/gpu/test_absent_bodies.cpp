// Bodies that are not there, on the GPU against the double precision reference of the same pixels: seen, through panes and gas, in shadows, drawn small.
#include <gtest/gtest.h>

#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Half of the things are there at the first frame. `odd`: which half.
std::string crowd(bool odd, const std::string& mode) {
  int given = 0;
  const auto life = [&] { return std::string(given++ % 2 == (odd ? 1 : 0) ? "" : ", begin: 1 s"); };
  std::string text =
      "render: {mode: " + mode +
      "}\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\nbackground: {temperature: 250 K}\n"
      "materials:\n  grey: {components: [{reflection: lambertian, reflectance: 0.4}]}\n"
      "  pane: {components: [{reflection: lambertian, reflectance: 0.1}], transmission: {transmittance: 0.5}}\n  gas: {medium: gas, absorption: 0.5 /m}\n"
      "lights:\n";
  for (int k = 0; k < 2; ++k)
    text += "  - {name: l" + std::to_string(k) + ", intensity: 40 W/(sr um), position: [3 m, " + std::to_string(4 * k - 2) + " m, 4 m]" + life() + "}\n";
  text += "entities:\n  - {name: wall, shape: {model: plate, width: 14 m, height: 8 m}, material: grey, temperature: 290 K, position: [-2 m, 0 m, 0 m]}\n";
  const char* shapes[] = {"{model: sphere, radius: 0.6 m}", "{model: box, length: 1 m, width: 1 m, height: 1 m}", "{model: sphere, radius: 4 cm}"};
  int n = 0;
  for (const char* material : {"grey", "pane", "gas"})
    for (const char* shape : shapes)
      for (int twice = 0; twice < 2; ++twice, ++n)
        text += "  - {name: e" + std::to_string(n) + ", shape: " + shape + ", material: " + material + ", temperature: " + std::to_string(300 + 20 * n) +
                " K, position: [" + std::to_string(0.3 * (n % 5)) + " m, " + std::to_string(1.3 * (n % 6) - 3.2) + " m, " +
                std::to_string(1.2 * (n / 6) - 1.2) + " m]" + life() + "}\n";
  return text +
         "cameras: [{name: c, film: {width: 60, height: 36}, field_of_view: 40 deg, aperture: 5 mm, position: [12 m, 0 m, 1 m], look_at: [0 m, 0 m, 0 m], "
         "small_bodies: 0, channels: "
         "[{name: a, response: {band: [3.2 um, 4.8 um]}}]}]\n";
}

TEST(AbsentBodies, GpuAgainstDouble) {
  for (bool odd : {false, true}) {
    const Worst w = compare(scene(crowd(odd, "auto")), 1);
    EXPECT_GT(w.covered, 1500.0);
    bound(std::string("GPU against CPU double with half of the bodies absent, ") + (odd ? "odd" : "even"), w.error, 1e-4, "panes and gas in single precision");
  }
}

// The same bodies in a scenario that never had the others: the pictures are the same to single precision, by both.
TEST(AbsentBodies, AsIfTheyWereNotInTheScenario) {
  for (bool odd : {false, true}) {
    const std::string all = crowd(odd, "buffered");
    std::string some;
    std::stringstream lines(all);
    for (std::string line; std::getline(lines, line);)
      if (line.find("begin: 1 s") == std::string::npos) some += line + "\n";
    ASSERT_LT(some.size(), all.size() - 500);
    const Frame with = renderFrame(scene(all)), without = renderFrame(scene(some));
    const auto &x = layer(with, "a.radiance").pixels, &y = layer(without, "a.radiance").pixels;
    double worst = 0.0;
    for (size_t p = 0; p < x.size(); ++p) worst = std::max(worst, std::abs(static_cast<double>(x[p]) / static_cast<double>(y[p]) - 1.0));
    bound("absent against never there", worst, 2e-6, "lights and bodies have other numbers: sums in another order");
  }
}

}  // namespace
}  // namespace pitviper::test
