// Buffered mode against direct mode: the same nodes, so the same picture to rounding.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

double worstDifference(const std::string& yaml) {
  const Frame direct = renderFrame(scene(yaml + "render: {mode: direct}\n")), buffered = renderFrame(scene(yaml + "render: {mode: buffered}\n"));
  double worst = 0.0;
  for (size_t l = 0; l < direct.layers.size(); ++l)
    for (size_t p = 0; p < direct.layers[l].pixels.size(); ++p) {
      const double a = static_cast<double>(direct.layers[l].pixels[p]), b = static_cast<double>(buffered.layers[l].pixels[p]);
      EXPECT_TRUE(std::isfinite(b));
      if (a != b) worst = std::max(worst, std::abs(a - b) / std::max(std::abs(a), 1e-30));
    }
  return worst;
}

std::string body(const std::string& spectral, int channels) {
  std::string y =
      "atmosphere: {extinction: 0.4 /km, temperature: 285 K}\nambient: {temperature: 260 K}\nsun: {azimuth: 60 deg, elevation: 35 deg, temperature: 5772 K}\n"
      "lights: [{name: l, intensity: 40 W/(sr um), position: [5 m, 2 m, 4 m]}]\n"
      "entities:\n  - {name: a, shape: {model: sphere, radius: 1 m}, material: black_gloss_paint, temperature: 310 K}\n"
      "  - {name: far, shape: {model: sphere, radius: 0.1 m}, material: sand, temperature: 400 K, position: [-40 m, 8 m, 1 m]}\n"
      "cameras:\n  - name: c\n    film: {width: 48, height: 40}\n    field_of_view: 30 deg\n    aperture: 5 mm\n    position: [9 m, 0 m, 1 m]\n    look_at: a\n"
      "    truth: [range, entity, normal, temperature, area, solid_angles]\n    spectral: " +
      spectral + "\n    channels:\n";
  for (int c = 0; c < channels; ++c)
    y += "      - {name: c" + std::to_string(c) + ", response: {band: [" + std::to_string(3.0 + 0.1 * c) + " um, " + std::to_string(5.0 + 0.2 * c) + " um]}}\n";
  return y;
}

TEST(Buffered, EqualsDirect) {
  bound("buffered against direct, 1 channel, 16 nodes", worstDifference(body("{samples: 16}", 1)), 1e-5, "same nodes; order of sums");
  bound("buffered against direct, 16 channels, 256 nodes in 8 batches", worstDifference(body("{samples: 16}", 16)), 1e-5, "same nodes; order of sums");
  bound("buffered against direct, 5 channels, 33 nodes shared", worstDifference(body("{samples: 33, spacing: even, shared: true}", 5)), 1e-5,
        "same nodes; order of sums");
}

}  // namespace
}  // namespace pitviper::test
