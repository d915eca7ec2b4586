#include "sensors/noise_source.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53u} * c[0], b = std::uint64_t{0xCD9E8D57u} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ k[1],
         static_cast<std::uint32_t>(a)};
    k[0] += 0x9E3779B9u, k[1] += 0xBB67AE85u;
  }
  return c;
}

std::array<double, 2> NoiseSource::pair(std::uint32_t place, std::uint32_t draw) const {
  const auto bits = philox({place, draw, frame_, effect_}, key_);
  const auto of = [](std::uint32_t high, std::uint32_t low) { return (static_cast<double>(((std::uint64_t{high} << 32) | low) >> 12) + 0.5) * 0x1p-52; };
  return {of(bits[0], bits[1]), of(bits[2], bits[3])};
}

double NoiseSource::uniform(std::uint32_t place, std::uint32_t draw) const { return pair(place, draw)[0]; }

double NoiseSource::normal(std::uint32_t place, std::uint32_t draw) const {
  const auto [u, v] = pair(place, draw);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

double NoiseSource::poisson(double mean, std::uint32_t place) const {
  constexpr double kInverted = 10.0, kNormal = 1e7;
  if (!(mean > 0.0)) return 0.0;
  if (mean < kInverted) {
    double left = uniform(place), term = std::exp(-mean);
    int k = 0;
    for (; left > term && k < 200; ++k) left -= term, term *= mean / (k + 1);
    return k;
  }
  if (mean > kNormal) return std::max(0.0, std::round(mean + std::sqrt(mean) * normal(place)));
  const double root = std::sqrt(mean), b = 0.931 + 2.53 * root, a = -0.059 + 0.02483 * b, inverse = 1.1239 + 1.1328 / (b - 3.4),
               limit = 0.9277 - 3.6224 / (b - 2.0);
  for (std::uint32_t draw = 0;; ++draw) {
    auto [u, v] = pair(place, draw);
    u -= 0.5;
    const double away = 0.5 - std::abs(u), k = std::floor((2.0 * a / away + b) * u + mean + 0.43);
    if (away >= 0.07 && v <= limit) return k;
    if (k < 0.0 || (away < 0.013 && v > away)) continue;
    if (std::log(v) + std::log(inverse) - std::log(a / (away * away) + b) <= -mean + k * std::log(mean) - std::lgamma(k + 1.0)) return k;
  }
}

}  // namespace pitviper
