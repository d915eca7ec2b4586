#include "sim/image/srgb.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pitviper {

glm::dvec3 linearSrgb(const glm::dvec3& c) {
  return {3.2406 * c.x - 1.5372 * c.y - 0.4986 * c.z, -0.9689 * c.x + 1.8758 * c.y + 0.0415 * c.z, 0.0557 * c.x - 0.2040 * c.y + 1.0570 * c.z};
}

Rgb8 srgbPixel(const glm::dvec3& linear) {
  const auto coded = [](double v) {
    v = std::clamp(v, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055)));
  };
  return {coded(linear.x), coded(linear.y), coded(linear.z)};
}

std::vector<Rgb8> srgbPixels(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z, double white) {
  std::vector<Rgb8> all;
  all.reserve(y.size());
  const double scale = white > 0.0 ? 1.0 / white : 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) all.push_back(srgbPixel(linearSrgb(scale * glm::dvec3(x[i], y[i], z[i]))));
  return all;
}

std::vector<float> strongestPrimary(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z) {
  std::vector<float> all;
  all.reserve(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    const glm::dvec3 c = linearSrgb({x[i], y[i], z[i]});
    all.push_back(static_cast<float>(std::max({c.x, c.y, c.z})));
  }
  return all;
}

}  // namespace pitviper
