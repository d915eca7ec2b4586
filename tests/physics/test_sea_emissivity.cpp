// What a sea emits, against published tables and rays traced over seas. (Where it goes: tests/physics; holds with sea_and_foam.patch.)
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "sim/camera/camera_renderer.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::shared_ptr<const Material> material(const std::string& component) {
  static std::vector<Simulation> kept;
  kept.push_back(
      scene("materials: {m: {components: [" + component +
            "]}}\ncameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [1 m, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
            "channels: [{name: v, response: {band: [4 um, 4.1 um]}}]}]\n"));
  return kept.back().materials.front();
}
std::shared_ptr<const Material> sea(double wind, double n, double k, const std::string& more = ", foam: 0") {
  // Beyond Cox and Munk's winds, facets of the slopes that their law goes on to.
  if (wind > 14.0)
    return material(print("{reflection: microfacet, index: {n: %g, k: %g}, slopes: normal, roughness: %.9g}", n, k, std::sqrt(0.003 + 5.12e-3 * wind)));
  return material(print("{reflection: sea, wind: %g m/s, index: {n: %g, k: %g}", wind, n, k) + more + "}");
}
double emissivity(const Material& m, double um, double degrees) { return 1.0 - m.reflectance(um, degrees * kPi / 180.0); }

// Masuda, Takashima and Takayama, Remote Sens. Environ. 24, 313 (1988): of each facet once, whose mirror image never meets the sea again; 0 to 60 degrees.
// Rays traced: all reflections; 60, 70, 75, 80 degrees, mean of two normally distributed seas (one scale; k^-4 over 1.6 decades), 320,000 rays each.
struct Sea {
  double um, n, k, wind;
  std::array<double, 4> masuda;  ///< 0, 30, 50, 60 degrees
  std::array<double, 4> traced;
};
const std::array<Sea, 6> kSeas{{
    {4.0, 1.357, 0.0046, 5, {0.97704, 0.97533, 0.96019, 0.93106}, {0.9327, 0.8710, 0.8198, 0.7519}},
    {4.0, 1.357, 0.0046, 10, {0.97699, 0.97476, 0.95779, 0.92792}, {0.9352, 0.8864, 0.8481, 0.7992}},
    {4.0, 1.357, 0.0046, 15, {0.97692, 0.97415, 0.95555, 0.92594}, {0.9386, 0.8980, 0.8674, 0.8282}},
    {11.0, 1.162, 0.0938, 5, {0.99251, 0.99165, 0.98277, 0.96270}, {0.9641, 0.9158, 0.8719, 0.8097}},
    {11.0, 1.162, 0.0938, 10, {0.99249, 0.99134, 0.98091, 0.95938}, {0.9653, 0.9276, 0.8954, 0.8519}},
    {11.0, 1.162, 0.0938, 15, {0.99245, 0.99098, 0.97908, 0.95705}, {0.9676, 0.9364, 0.9111, 0.8771}},
}};

TEST(SeaEmissivity, OfTablesAndRays) {
  for (const Sea& s : kSeas) {
    const auto m = sea(s.wind, s.n, s.k);
    for (size_t i = 0; i < 3; ++i) {
      const double degrees = std::array{0.0, 30.0, 50.0}[i];
      // A share of up to 4 % of what is reflected meets the sea again at 50 degrees and 15 m/s, and half of that stays.
      bound(print("emissivity at %.0f um, %.0f m/s, %.0f deg, from Masuda's %.5f", s.um, s.wind, degrees, s.masuda[i]),
            std::abs(emissivity(*m, s.um, degrees) - s.masuda[i]), i < 2 ? 4e-4 : 6e-3, "several reflections are not in the table");
    }
    EXPECT_GE(emissivity(*m, s.um, 60.0), s.masuda[3] - 1e-4);
    for (size_t i = 0; i < 4; ++i) {
      const double degrees = std::array{60.0, 70.0, 75.0, 80.0}[i];
      bound(print("emissivity at %.0f um, %.0f m/s, %.0f deg, from %.4f of rays", s.um, s.wind, degrees, s.traced[i]),
            std::abs(emissivity(*m, s.um, degrees) - s.traced[i]), 5e-3, "two seas of the same slopes are up to 0.007 apart at 80 degrees");
    }
  }
}

// Whitecaps: shares add up.
TEST(SeaEmissivity, FoamIsAShare) {
  const auto bare = sea(12.0, 1.33, 1e-4), white = sea(12.0, 1.33, 1e-4, ""), all = sea(12.0, 1.33, 1e-4, ", foam: 1");
  const double w = 3.84e-6 * std::pow(12.0, 3.41);
  for (double um : {0.5, 1.02, 4.0})
    for (double degrees : {0.0, 45.0, 80.0}) {
      const double a = degrees * kPi / 180.0;
      figure(print("reflectance at %.2f um, %.0f deg", um, degrees), white->reflectance(um, a),
             (1.0 - w) * bare->reflectance(um, a) + w * all->reflectance(um, a), 1e-9, "a mixture");
    }
  figure("of foam alone at 0.44 um", all->reflectance(0.44, 0.3), 0.22, 1e-9, "Koepke 1984");
}

// Facets of the waves that a shape does not draw are smoother.
TEST(SeaEmissivity, DrawnSlopesAreLeftOut) {
  const auto far = sea(10.0, 1.357, 0.0046), fine = sea(10.0, 1.357, 0.0046, ", foam: 0, step: 0.2 m"),
             coarse = sea(10.0, 1.357, 0.0046, ", foam: 0, step: 5 m"), calm = sea(0.0, 1.357, 0.0046);
  EXPECT_LT(emissivity(*calm, 4.0, 85.0), emissivity(*fine, 4.0, 85.0));
  EXPECT_LT(emissivity(*fine, 4.0, 85.0), emissivity(*coarse, 4.0, 85.0));
  EXPECT_LT(emissivity(*coarse, 4.0, 85.0), emissivity(*far, 4.0, 85.0));
}

// Waves drawn one by one, with facets of the rest, and facets alone: from above the same on the whole.
TEST(SeaEmissivity, DrawnWavesAreTheSameSea) {
  const auto meanOf = [](const std::string& surface) {
    const Frame frame =
        renderFrame(scene("atmosphere: none\nambient: {temperature: 220 K}\naccuracy: reference\n" + surface +
                          "cameras: [{name: e, film: {width: 60, height: 40}, field_of_view: 40 deg, aperture: 5 mm, position: [-60 m, 0 m, 100 m], "
                          "heading: 90 deg, pitch: -60 deg, samples: 3, channels: [{name: v, response: {band: [10.9 um, 11.1 um]}, output: radiance}]}]\n"));
    double sum = 0.0, squares = 0.0;
    for (float v : frame.layers[0].pixels) sum += static_cast<double>(v), squares += static_cast<double>(v) * static_cast<double>(v);
    const double count = static_cast<double>(frame.layers[0].pixels.size()), mean = sum / count;
    return std::pair(mean, std::sqrt(std::max(squares / count - mean * mean, 0.0)) / mean);
  };
  const std::string body =
                        "entities: [{name: s, shape: {model: sea, size: 400 m, wind: 10 m/s, points: 256}, material: {description: x, source: x, components: "
                        "[{reflection: sea, wind: 10 m/s, foam: 0, step: 1.5625 m}]}, temperature: 290 K}]\n",
                    even = "ground: {material: {description: x, source: x, components: [{reflection: sea, wind: 10 m/s, foam: 0}]}, temperature: 290 K}\n";
  const auto [drawn, clutter] = meanOf(body);
  const auto [facets, none] = meanOf(even);
  figure("mean radiance of a drawn sea from above [W/(m2 sr)]", drawn, facets, 3e-3, "facets alone, of the same slopes");
  std::printf("clutter of drawn waves %.2g of the mean, of facets %.2g\n", clutter, none);
  EXPECT_GT(clutter, 1.2 * none);
}

}  // namespace
}  // namespace pitviper::test
