// What of a tower beyond the horizon is seen, and where its top stands, with and without refraction.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0, kEye_m = 10.0, kTop_m = 100.0, kPixel_rad = 2.4e-5;
constexpr int kRows = 401;

/// Rows of the picture that show the tower, and the angle of its top over the level of the eye [rad].
std::pair<double, double> towerIn(const std::string& refraction) {
  const Simulation sim = scene(
      refraction +
      "\nbackground: {temperature: 0 K}\norigin: {latitude: 50 deg, longitude: 8 deg, height: 0 m}\nmaterials: {m: {}}\n"
      "entities: [{name: sea, shape: {model: ground}, material: m, temperature: 1 K}, {name: tower, shape: {model: box, length: 200 m, width: 200 m, height: "
      "200 m}, material: m, temperature: 300 K, "
      "geodetic: {latitude: 50.225 deg, longitude: 8 deg, height: 0 m}}]\n" +
      print("cameras: [{name: c, film: {width: 3, height: %d, pitch: 50 um}, focal_length: %.9g m, aperture: 5 mm, position: [0 m, 0 m, %g m], heading: 0 deg, "
            "pitch: 0 deg, samples: 4, channels: [{name: lw, response: {band: [8 um, 12 um]}}]}]\n",
            kRows, 50e-6 / kPixel_rad, kEye_m));
  const Frame f = renderFrame(sim);
  const FrameLayer& l = layer(f, "lw.radiance");
  const double whole = blackBodyBand(8, 12, 300.0);
  double rows = 0.0, above = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double share = at(l, f, 1, row) / whole;
    rows += share;
    if (rows == 0.0) ++above;
    else if (above == std::floor(above)) above += 1.0 - share - 1e-9;
  }
  return {rows, (0.5 * kRows - above) * kPixel_rad};
}

TEST(RefractionInPictures, ATowerBeyondTheHorizon) {
  const double d = 25028.0, radius = 6381000.0;  // 0.225 degrees along a meridian there; Gaussian radius
  const auto expected = [&](double k) {
    const double r = radius / (1.0 - k), beyond = d - 100.0 - std::sqrt(2.0 * r * kEye_m);
    const double top = (kTop_m - kEye_m - d * d / (2.0 * r)) / (d - 100.0);
    return std::pair{(kTop_m - beyond * beyond / (2.0 * r)) / (d - 100.0) / kPixel_rad, top};
  };
  for (const auto& [key, k] : {std::pair{"", 0.0}, {"refraction: {coefficient: 0.13}", 0.13}, {"refraction: {coefficient: 0.3}", 0.3}}) {
    const auto [rows, top] = towerIn(key);
    const auto [rowsExpected, topExpected] = expected(k);
    figure(print("rows of a tower beyond the horizon, k = %g", k), rows, rowsExpected, 0.008, "height less (d - d_h)^2 / (2 R_eff); a row of 140");
    figure(print("elevation of its top, k = %g [rad]", k), top, topExpected, 0.012, "curvature; half a row of 70");
  }
}

}  // namespace
}  // namespace pitviper::test
