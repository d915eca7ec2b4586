// A hot target far smaller than a pixel behind a puff of smoke smaller than 16 pixels: both are drawn by zoomed views of their own, and what
// the smoke takes away must be taken from the target as finely as it was added.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kRadius_m = 0.4, kRange_m = 3000.0, kSmoke_m = 16.0;

Frame picture(double absorption_per_m, bool hot, const std::string& target) {
  const std::string y =
      "background: {temperature: 265 K}\nmaterials:\n  smoke: {absorption: " + std::to_string(absorption_per_m) +
      " /m}\n  gas: {absorption: 50 /m}\nentities:\n" +
      (hot ? "  - {name: hot, shape: {model: sphere, radius: 0.4 m}, material: " + target + ", temperature: 1600 K, position: [0 m, 3 km, 0 m]}\n" : "") +
      "  - {name: smoke, shape: {model: sphere, radius: 16 m}, material: smoke, temperature: 295 K, position: [0.7 m, 1500 m, 0.4 m]}\n"
      "cameras:\n  - name: c\n    film: {width: 33, height: 33}\n    field_of_view: 5.13 deg\n    aperture: 20 mm\n    position: [0 m, 0 m, 0 m]\n"
      "    heading: 0 deg\n    channels: [{name: red, response: {band: [4.4 um, 4.7 um]}, output: [radiance, flux]}]\n";
  return renderFrame(scene(y));
}

TEST(SmallBehindSmoke, IsDimmedByTheSmokeAlone) {
  const double aperture_m2 = 3.14159265358979324 * 0.01 * 0.01;
  for (const std::string target : {"blackbody", "gas"})
    for (double k : {0.0, 0.005, 0.05, 0.3}) {
      const Frame with = picture(k, true, target), without = picture(k, false, target);
      const double excess = sum(layer(with, "red.flux")) - sum(layer(without, "red.flux"));
      // The line of sight passes the puff's middle at 0.81 m.
      const double chord = 2.0 * std::sqrt(kSmoke_m * kSmoke_m - 0.7 * 0.7 - 0.4 * 0.4),
                   contrast = blackBodyBand(4.4, 4.7, 1600.0) - blackBodyBand(4.4, 4.7, 265.0);
      const double expected = std::exp(-k * chord) * contrast * 3.14159265358979324 * kRadius_m * kRadius_m / (kRange_m * kRange_m) * aperture_m2;
      char name[96];
      std::snprintf(name, sizeof name, "small %s behind smoke of optical depth %.2g, flux [W]", target.c_str(), k * chord);
      figure(name, excess, expected, k > 0.1 ? 2e-2 : 3e-3,
             "pi r2 (B - B_bg) exp(-k s)/R2; silhouettes on 256 and 128 across, gas of depth 20 at its middle; difference of single precision pictures");
      const auto& pixels = layer(with, "red.radiance").pixels;
      EXPECT_GT(static_cast<double>(*std::min_element(pixels.begin(), pixels.end())), 0.9 * blackBodyBand(4.4, 4.7, 265.0));
    }
}

}  // namespace
}  // namespace pitviper::test
