// A chequered plate whose texels are a third to a half of a pixel: pixels have the mean of what their texels send, not what the mean temperature would.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr int kTexels = 64;

std::string chequered(const std::string& head, double turn_deg) {
  std::string rows;
  for (int y = 0; y < kTexels; ++y) {
    rows += y ? ", [" : "[";
    for (int x = 0; x < kTexels; ++x) rows += std::string(x ? ", " : "") + ((x + y) % 2 ? "260 K" : "340 K");
    rows += "]";
  }
  return head +
         "background: {temperature: 0 K}\nentities:\n  - {name: p, shape: {model: plate, width: 40 m, height: 40 m}, material: blackbody, temperature: {rows: "
         "[" +
         rows + "]}, position: [0 m, 1000 m, 0 m], heading: " + std::to_string(180.0 + turn_deg) +
         " deg}\ncameras:\n  - {name: c, film: {width: 24, height: 24}, field_of_view: 1.65 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg,\n"
         "     channels: [{name: mw, response: {band: [3.7 um, 4.9 um]}}]}\n";
}

/// Least and largest of the pixels well inside the plate, by the expected mean.
std::pair<double, double> rangeOf(const std::string& head, double turn_deg, double expected) {
  const CameraImage image = renderImage(scene(chequered(head, turn_deg)));
  double low = 1e9, high = 0.0;
  for (int y = 6; y < 18; ++y)
    for (int x = 6; x < 18; ++x) {
      const double l = image.slots[0][static_cast<std::size_t>(24 * y + x)] / expected;
      low = std::min(low, l), high = std::max(high, l);
    }
  return {low, high};
}

TEST(TextureMeans, OfWhatTexelsSend) {
  // Between the middles of four texels: 300 K + 40 K u v, u and v even over -1 to 1.
  double expected = 0.0;
  constexpr int kFine = 80;
  for (int j = 0; j < kFine; ++j)
    for (int i = 0; i < kFine; ++i)
      expected += blackBodyBand(3.7, 4.9, 300.0 + 40.0 * ((2.0 * i + 1.0) / kFine - 1.0) * ((2.0 * j + 1.0) / kFine - 1.0)) / (kFine * kFine);
  ASSERT_GT(expected / blackBodyBand(3.7, 4.9, 300.0), 1.03) << "or else the mean temperature would do";
  // Of a chequer, the worst there is, a pixel of two texels and less is left a few thousandths; see test_texture_filter.cpp.
  for (double turn_deg : {20.0, 55.0})
    for (const auto& [head, allowed] : {std::pair{"accuracy: 1 %\n", 0.012}, {"accuracy: 0.3 %\n", 0.012}, {"accuracy: reference\n", 0.012}}) {
      const auto [low, high] = rangeOf(head, turn_deg, expected);
      bound(std::string("chequer at ") + std::to_string(static_cast<int>(turn_deg)) + " deg, " + std::string(head, 10, std::string(head).size() - 11) +
                ": pixels off by",
            std::max(high - 1.0, 1.0 - low), allowed, "mean of Planck's law over the chequer");
    }
  const auto [low, high] = rangeOf("accuracy: none\n", 20.0, expected);
  EXPECT_GT(high - low, 0.3) << "single places: or else this test sees nothing";
}

// Texels much larger than pixels, 700 K apart: powers of the difference must not swallow what is left within a pixel in single precision.
TEST(TextureMeans, LargeTexelsOfHotAndCold) {
  const auto picture = [](const std::string& accuracy) {
    return renderImage(
        scene("accuracy: " + accuracy +
              "\nbackground: {temperature: 0 K}\nentities:\n  - {name: p, shape: {model: plate, width: 60 m, height: 60 m}, material: blackbody, temperature: "
              "{rows: [[300 K, 1000 K, 300 K, 300 K], [300 K, 300 K, 1000 K, 300 K], [1000 K, 300 K, 300 K, 300 K], [300 K, 300 K, 300 K, 1000 K]]}, "
              "position: [0 m, 1000 m, 0 m], heading: 200 deg}\ncameras:\n  - {name: c, film: {width: 64, height: 64}, field_of_view: 2 deg, aperture: 20 mm, "
              "position: [0 m, 0 m, 0 m], heading: 0 deg,\n     channels: [{name: mw, response: {band: [3.7 um, 4.9 um]}}]}\n"));
  };
  const CameraImage planned = picture("1 %"), exact = picture("reference");
  double worst = 0.0;
  for (std::size_t p = 0; p < exact.slots[0].size(); ++p) worst = std::max(worst, std::abs(planned.slots[0][p] / exact.slots[0][p] - 1.0));
  bound("texels of 24 pixels, 300 and 1000 K: planned to 1 % against the reference", worst, 0.01, "as asked; textures of both are read alike at this size");
}

}  // namespace
}  // namespace pitviper::test
