#pragma once
// What tests of the camera that follows share: a film, a spectrum of jitter, pictures of a spot in noise.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "sensors/gimbal/follow_loop.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper::test {

constexpr double kDegree = kPi / 180.0;
constexpr double kRounding = 1e-12;  // of some thousand additions in double near 1

struct Randomly {
  std::mt19937_64 engine{20240715};
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
};

inline Pinhole film() {
  Pinhole p;
  p.width = 64;
  p.height = 48;
  p.focalLength_m = 0.1;
  p.pitchX_m = 20e-6;
  p.pitchY_m = 25e-6;
  return p;
}

inline AxisJitter table() {
  AxisJitter j;
  j.spectrum = {{1.0, 4e-10}, {5.0, 4e-10}, {20.0, 5e-11}, {30.0, 3e-10}, {35.0, 2e-11}, {150.0, 1e-12}};
  return j;
}

/// A Gaussian spot of deviation sigma_px, averaged over each pixel.
inline void addSpot(std::vector<float>& picture, int width, const glm::dvec2& at, double sigma_px, double sum) {
  const auto share = [&](double middle, int i) {
    const double scale = 1.0 / (sigma_px * std::sqrt(2.0));
    return 0.5 * (std::erf((i + 1 - middle) * scale) - std::erf((i - middle) * scale));
  };
  const int height = static_cast<int>(picture.size()) / width;
  for (int y = std::max(0, static_cast<int>(at.y - 9.0 * sigma_px)); y < std::min<double>(height, at.y + 9.0 * sigma_px); ++y)
    for (int x = std::max(0, static_cast<int>(at.x - 9.0 * sigma_px)); x < std::min<double>(width, at.x + 9.0 * sigma_px); ++x)
      picture[static_cast<size_t>(y * width + x)] += static_cast<float>(sum * share(at.x, x) * share(at.y, y));
}

inline std::vector<float> noise(int count, double mean, double deviation, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(mean, deviation);
  std::vector<float> picture;
  for (int i = 0; i < count; ++i) picture.push_back(static_cast<float>(normal(engine)));
  return picture;
}

}  // namespace pitviper::test
