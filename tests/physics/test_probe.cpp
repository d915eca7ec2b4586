// Irradiance on a plane against configuration factors. Error: a silhouette on 5 x 512^2 turned rays.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const std::string kProbe = "probes: [{name: e, position: [0 m, 0 m, 0 m], channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n";

// Element to a parallel rectangle above it (four corners): F = (2/pi) [X/sqrt(1+X2) atan(Y/sqrt(1+X2)) + Y/sqrt(1+Y2) atan(X/sqrt(1+Y2))],
// X = a/h, Y = b/h of half sides. Source: Howell, Catalog of radiation heat transfer configuration factors, B-4.
TEST(Probe, UnderASquare) {
  const auto sim = scene(
      "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: 400 K, position: [0 m, 0 m, 2 m], heading: 0 "
      "deg, pitch: -90 deg}]\n" +
      kProbe);
  const double x = 1.0, y = 1.0;
  const double factor =
      2.0 / kPi * (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) + y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)));
  figure("probe under a square [W/m2]", probeReading(sim)[0], factor * kPi * blackBodyBand(8, 12, 400), 1e-3, "configuration factor B-4; silhouette on rays");
}

// Element to a coaxial parallel disc: F = r2/(r2 + h2) (Howell B-12). Facets of the disc: 512 segments, area 2.5e-5 short.
TEST(Probe, UnderADisc) {
  const auto sim = scene(
      "entities: [{name: p, shape: {model: disc, radius: 1.5 m, segments: 512}, material: blackbody, temperature: 400 K, position: [0 m, 0 m, 2 m], heading: 0 "
      "deg, pitch: -90 deg}]\n" +
      kProbe);
  figure("probe under a disc [W/m2]", probeReading(sim)[0], 2.25 / (2.25 + 4.0) * kPi * blackBodyBand(8, 12, 400), 1e-3, "r2/(r2 + h2); silhouette on rays");
}

TEST(Probe, UniformSkyIsPiL) {
  figure("probe under a uniform sky [W/m2]", probeReading(scene("background: {temperature: 300 K}\n" + kProbe))[0], kPi * blackBodyBand(8, 12, 300), 1e-4,
         "pi L; midpoint rule over rays");
}

TEST(Probe, SunAndLamp) {
  const auto sim =
      scene("sun: {azimuth: 180 deg, elevation: 30 deg, irradiance: 10 W/(m2 um)}\nlights: [{name: l, intensity: 8 W/(sr um), position: [0 m, 3 m, 4 m]}]\n" +
            kProbe);
  figure("probe, sun at 30 deg and a lamp [W/m2]", probeReading(sim)[0], 4.0 * (10.0 * 0.5 + 8.0 * 0.8 / 25.0), 1e-6, "E sin(elevation) + I cos/d2");
}

// A body far smaller than the probe's rays keeps its irradiance, wherever it stands.
TEST(Probe, FarSphere) {
  double worst = 0.0;
  for (int i = 0; i < 5; ++i) {
    const auto sim = scene("entities: [{name: s, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 1000 K, position: [" +
                           std::to_string(600 + i) + " m, 30 m, 608 m]}]\n" + kProbe);
    const double r2 = (600.0 + i) * (600.0 + i) + 900.0 + 608.0 * 608.0;
    worst = std::max(worst, std::abs(probeReading(sim)[0] / (kPi * blackBodyBand(8, 12, 1000) / r2 * 608.0 / std::sqrt(r2)) - 1.0));
  }
  bound("probe, sphere of 1 m at 855 m, five places, worst error", worst, 5e-3, "pi L r2/R2 cos; zoomed view, the cosine of its ray's middle");
}

// The sun behind a plate does not reach the probe, the plate itself does.
TEST(Probe, ShadowedSun) {
  const auto sim = scene(
      "sun: {azimuth: 180 deg, elevation: 90 deg, irradiance: 10 W/(m2 um)}\n"
      "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: 0 K, position: [0 m, 0 m, 2 m], heading: 0 deg, "
      "pitch: -90 deg}]\n" +
      kProbe);
  EXPECT_EQ(probeReading(sim)[0], 0.0);
}

}  // namespace
}  // namespace pitviper::test
