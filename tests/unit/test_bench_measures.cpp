// What the lab bench makes of pictures whose figures are known.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sensors/edge_transfer.hpp"
#include "sensors/noise_components.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper::test {
namespace {

// Seven components made by another generator come back within their own standard errors.
TEST(BenchMeasures, NoiseComponentsComeBack) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  constexpr std::size_t T = 48, V = 60, H = 80;
  const std::array<double, 7> sigma{3.0, 2.0, 1.5, 2.5, 1.0, 4.0, 6.0};
  std::vector<double> t(T), v(V), h(H), tv(T * V), th(T * H), vh(V * H);
  for (auto [values, s] : {std::pair{&t, sigma[0]}, {&v, sigma[1]}, {&h, sigma[2]}, {&tv, sigma[3]}, {&th, sigma[4]}, {&vh, sigma[5]}})
    for (double& x : *values) x = s * normal(random);
  NoiseCube cube(H, V);
  for (std::size_t i = 0; i < T; ++i) {
    std::vector<float> frame;
    for (std::size_t y = 0; y < V; ++y)
      for (std::size_t x = 0; x < H; ++x)
        frame.push_back(static_cast<float>(1000.0 + t[i] + v[y] + h[x] + tv[i * V + y] + th[i * H + x] + vh[y * H + x] + sigma[6] * normal(random)));
    cube.add(frame);
  }
  const auto found = cube.components();
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k].sigma, sigma[k], 4.0 * found[k].error) << kNoiseNames[k];
    EXPECT_LT(found[k].error, 0.25 * sigma[k]) << kNoiseNames[k];
  }
  EXPECT_NEAR(cube.temporal(), std::sqrt(9.0 + 6.25 + 1.0 + 36.0), 0.35);
}

// An edge through a blur of Gauss, averaged over pixels: its closed form to Nyquist.
TEST(BenchMeasures, SlantedEdge) {
  for (double sigma : {0.3, 0.6, 1.2})
    for (double tilt : {3.0, -7.0}) {
      const std::size_t width = 96, height = 90;
      const double slope = std::tan(tilt * kPi / 180.0), cosine = std::cos(tilt * kPi / 180.0);
      std::vector<double> picture;
      for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
          double sum = 0.0;
          constexpr int kPlaces = 12;
          for (int j = 0; j < kPlaces; ++j)
            for (int i = 0; i < kPlaces; ++i) {
              const double px = static_cast<double>(x) + (i + 0.5) / kPlaces - 48.3, py = static_cast<double>(y) + (j + 0.5) / kPlaces - 45.0;
              sum += 0.5 * std::erfc(-(px - slope * py) * cosine / (sigma * std::sqrt(2.0))) / (kPlaces * kPlaces);
            }
          picture.push_back(200.0 + 5000.0 * sum);
        }
      const EdgeTransfer found = edgeTransfer(picture, width, height);
      EXPECT_NEAR(found.slope, slope, 2e-3);
      double worst = 0.0;
      for (double f = 0.02; f <= 0.5; f += 0.02) {
        const double wanted = std::exp(-2.0 * kPi * kPi * sigma * sigma * f * f) * std::sin(kPi * f * cosine) / (kPi * f * cosine);
        worst = std::max(worst, std::abs(found.at(f) - wanted));
      }
      EXPECT_LT(worst, 0.01) << "sigma " << sigma << ", tilt " << tilt;
    }
  EXPECT_THROW(edgeTransfer(std::vector<double>(400, 1.0), 20, 20), std::invalid_argument);
}

}  // namespace
}  // namespace pitviper::test
