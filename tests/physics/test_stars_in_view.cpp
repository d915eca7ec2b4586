// Stars in a picture: their flux, what hides them, the air before them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/camera/camera_renderer.hpp"
#include "sim/parameters/error.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string starScene(double azimuth_deg, double elevation_deg, const std::string& more) {
  return "origin: {latitude: 48 deg, longitude: 11 deg}\ntime: {date: 2026-01-15T22:00:00Z}\nstars: true\n" + more +
         "cameras: [{name: e, film: {width: 8, height: 8}, field_of_view: 0.5 deg, aperture: 5 mm, position: [0 m, 0 m, 2 m], heading: " +
         print("%.9g deg, pitch: %.9g", azimuth_deg, elevation_deg) +
         " deg, channels: [{name: v, response: {band: [0.5 um, 0.6 um]}, output: radiance}, {name: h, response: {band: [1.5 um, 1.7 um]}, output: "
         "radiance}]}]\n";
}

/// Of a layer: radiance times the pixel's solid angle [W/m2].
double fluxOf(const Simulation& sim, const Frame& frame, std::size_t layer) {
  const Pinhole& p = sim.cameras[0].pinhole;
  double sum = 0.0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      sum += at(frame.layers[layer], frame, x, y) * p.pitchX_m * p.pitchY_m / std::pow(p.focalLength_m, 2) *
             std::pow(1.0 + std::pow(p.tanX(x + 0.5), 2) + std::pow(p.tanY(y + 0.5), 2), -1.5);
  return sum;
}

// Sirius stands in the south that night. Expected: the irradiance of its table in each band, whatever the pixel; through the air times what that lets through;
// nothing behind a plate.
TEST(StarsInView, SendWhatTheirTableSays) {
  needContext();
  const Simulation any = scene(starScene(0.0, 0.0, "atmosphere: none\n"));
  const auto star = std::find_if(any.stars.begin(), any.stars.end(), [](const SkyStar& s) { return s.name.find("Sirius") != std::string::npos; });
  ASSERT_NE(star, any.stars.end());
  const double elevation_deg = std::asin(star->direction.z) * 180.0 / kPi, azimuth_deg = std::atan2(star->direction.x, star->direction.y) * 180.0 / kPi;
  EXPECT_GT(elevation_deg, 15.0);
  const Simulation bare = scene(starScene(azimuth_deg, elevation_deg, "atmosphere: none\n")),
                   air = scene(starScene(azimuth_deg, elevation_deg, "atmosphere: hazy_us76\n")),
                   hidden = scene(starScene(
                       azimuth_deg, elevation_deg,
                       "atmosphere: none\nentities: [{name: p, shape: {model: sphere, radius: 5 m}, material: blackbody, temperature: 100 K, "
                       "position: [" +
                           print("%.6g m, %.6g m, %.6g m", 100.0 * star->direction.x, 100.0 * star->direction.y, 2.0 + 100.0 * star->direction.z) + "]}]\n"));
  const Frame clear = renderFrame(bare), through = renderFrame(air), behind = renderFrame(hidden);
  for (const auto& [layer, low, high] : {std::tuple{std::size_t{0}, 0.5, 0.6}, {std::size_t{1}, 1.5, 1.7}}) {
    double sum = 0.0;
    constexpr int kSteps = 200;
    for (int k = 0; k < kSteps; ++k) sum += star->irradiance(low + (high - low) * (k + 0.5) / kSteps) * (high - low) / kSteps;
    figure(print("irradiance of Sirius, %g to %g um [W/m2]", low, high), fluxOf(bare, clear, layer), sum, 2e-3, "its table; spectral samples, pixels' middles");
    const AirAmounts way = air.air->amounts({2.0, star->direction.z, air.frame.earthRadius_m()}, physics::kFar);
    double dimmed = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double um = low + (high - low) * (k + 0.5) / kSteps;
      dimmed += star->irradiance(um) * air.air->transmittance(nodeAt(air, um).air, way) * (high - low) / kSteps;
    }
    Simulation dark = air;
    dark.stars.clear();
    const double seen = fluxOf(air, through, layer) - fluxOf(dark, renderFrame(dark), layer);
    figure(print("what the air lets through of it, %g to %g um", low, high), seen / sum, dimmed / sum, 5e-3,
           "its spectrum by the air's; wavelengths of either");
    EXPECT_LT(fluxOf(hidden, behind, layer), 1e-6 * sum);
  }
}

TEST(StarsInView, AskForADateAndAPlace) {
  for (const auto& [text, told] : {std::pair{"stars: true\ntime: {date: 2026-01-15T22:00:00Z}\n", "no origin"},
                                   {"stars: true\norigin: {latitude: 1 deg, longitude: 2 deg}\n", "no date"}}) {
    try {
      scene(std::string(text) +
            "cameras: [{name: e, film: {width: 8, height: 8}, field_of_view: 0.5 deg, aperture: 5 mm, position: [0 m, 0 m, 2 m], heading: 0 deg, "
            "pitch: 0 deg, channels: [{name: v, response: {band: [0.5 um, 0.6 um]}}]}]\n");
      ADD_FAILURE() << text;
    } catch (const UserError& e) {
      EXPECT_NE(std::string(e.what()).find(told), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("test.yaml:1:"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace pitviper::test
