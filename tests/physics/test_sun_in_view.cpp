// The sun's disc in a picture: its radiance and flux, what hides it, the air before it.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/camera/camera_renderer.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// Irradiance 1000 W/(m2 um) in a band of 0.1 um, seen over a square of so many degrees.
std::string sunScene(double elevation_deg, double field_deg, int pixels, const std::string& more) {
  return "sun: {azimuth: 0 deg, elevation: " + print("%g", elevation_deg) + " deg, irradiance: 1000 W/(m2 um)}\n" + more +
         "cameras: [{name: e, film: {width: " + print("%d, height: %d", pixels, pixels) + "}, field_of_view: " + print("%g", field_deg) +
         " deg, aperture: 5 mm, position: [0 m, 0 m, 2 m], heading: 0 deg, pitch: " + print("%g", elevation_deg) +
         " deg, channels: [{name: v, response: {band: [0.8 um, 0.9 um]}, output: radiance}]}]\n";
}

/// On a plane that faces the camera [W/m2]: radiance times the integral of cos^4 over the tangents of each pixel.
double irradianceIn(const Simulation& sim, const Frame& frame) {
  const Pinhole& p = sim.cameras[0].pinhole;
  constexpr int kAcross = 20;
  double sum = 0.0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      double projected = 0.0;
      for (int j = 0; j < kAcross; ++j)
        for (int i = 0; i < kAcross; ++i)
          projected += std::pow(1.0 + std::pow(p.tanX(x + (i + 0.5) / kAcross), 2) + std::pow(p.tanY(y + (j + 0.5) / kAcross), 2), -2.0);
      sum += at(frame.layers[0], frame, x, y) * projected * p.pitchX_m * p.pitchY_m / std::pow(p.focalLength_m * kAcross, 2);
    }
  return sum;
}

TEST(SunInView, HasTheIrradianceThatLightsSurfaces) {
  for (const auto& [field_deg, pixels] : {std::pair{1.0, 64}, {1.0, 9}, {20.0, 24}, {60.0, 8}}) {
    const Simulation sim = scene(sunScene(30.0, field_deg, pixels, "atmosphere: none\n"));
    const Frame frame = renderFrame(sim);
    figure(print("irradiance of the sun's pixels, %g degrees over %d [W/m2]", field_deg, pixels), irradianceIn(sim, frame), 100.0, 5e-3,
           "what the scenario gives; shares of pixels by 64 lines and more, projected areas");
    if (pixels == 64)
      figure("radiance in its middle [W/(m2 sr)]", at(frame.layers[0], frame, 32, 32), 100.0 / (kPi * std::pow(physics::sunRadius(), 2)), 1e-6, "E / (pi r^2)");
  }
}

TEST(SunInView, IsHiddenByBodiesAndTheEarthAndDimmedByAir) {
  const std::string plate =
      "entities: [{name: p, shape: {model: plate, width: 40 m, height: 20 m}, material: {description: x, source: x, components: [{reflection: lambertian, "
      "reflectance: 0}]}, temperature: 100 K, position: [0 m, 1000 m, 6.7271 m], heading: 180 deg}]\n";
  // Its upper edge at 16.7271 m: 14.7271 m above the eye, the tangent of the sun's 0.84375 degrees.
  const Simulation half = scene(sunScene(0.84375, 1.0, 64, "atmosphere: none\n" + plate)),
                   set = scene(sunScene(-std::acos(6371e3 / (6371e3 + 2.0)) * 180.0 / kPi, 1.0, 64, "atmosphere: none\nground: {temperature: 100 K}\n")),
                   air = scene(sunScene(10.0, 1.0, 64, "atmosphere: hazy_us76\n"));
  bound("half of it above the edge of a plate, off a half", std::abs(irradianceIn(half, renderFrame(half)) / 50.0 - 1.0), 0.03, "a row of pixels is 1.5 %");
  bound("half of it above the horizon, off a half", std::abs(irradianceIn(set, renderFrame(set)) / 50.0 - 1.0), 0.02, "lines across pixels, 8 to a side");
  double passed = 0.0;
  for (double um = 0.8005; um < 0.9; um += 0.001)
    passed += 1e-2 * air.air->transmittance(air.air->node(um), air.air->amounts({2.0, std::sin(10.0 * kPi / 180.0), air.frame.earthRadius_m()}, physics::kFar));
  const Frame frame = renderFrame(air);
  // The sky around it is bright too: that of a corner is taken off.
  const double sky = at(frame.layers[0], frame, 2, 2), middle = at(frame.layers[0], frame, 32, 32);
  figure("radiance through hazy air [W/(m2 sr)]", middle - sky, passed * 100.0 / (kPi * std::pow(physics::sunRadius(), 2)), 0.01,
         "the band's mean transmittance; 1 % asked");
}

}  // namespace
}  // namespace pitviper::test
