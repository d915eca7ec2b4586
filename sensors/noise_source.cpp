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

double normalQuantile(double u) {
  const double q = u - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q *
           (((((((2509.0809287301226727 * r + 33430.575583588128105) * r + 67265.770927008700853) * r + 45921.953931549871457) * r + 13731.693765509461125) * r +
              1971.5909503065514427) * r + 133.14166789178437745) * r + 3.387132872796366608) /
           (((((((5226.495278852545925 * r + 28729.085735721942674) * r + 39307.89580009271061) * r + 21213.794301586595867) * r + 5394.1960214247511077) * r +
              687.1870074920579083) * r + 42.313330701600911252) * r + 1.0);
  }
  double r = std::sqrt(-std::log(q < 0.0 ? u : 1.0 - u)), value;
  if (r <= 5.0) {
    r -= 1.6;
    value = (((((((7.7454501427834140764e-4 * r + 0.0227238449892691845833) * r + 0.24178072517745061177) * r + 1.27045825245236838258) * r + 3.64784832476320460504) * r +
               5.7694972214606914055) * r + 4.6303378461565452959) * r + 1.42343711074968357734) /
            (((((((1.05075007164441684324e-9 * r + 5.475938084995344946e-4) * r + 0.0151986665636164571966) * r + 0.14810397642748007459) * r + 0.68976733498510000455) * r +
               1.6763848301838038494) * r + 2.05319162663775882187) * r + 1.0);
  } else {
    r -= 5.0;
    value = (((((((2.01033439929228813265e-7 * r + 2.71155556874348757815e-5) * r + 0.0012426609473880784386) * r + 0.026532189526576123093) * r + 0.29656057182850489123) * r +
               1.7848265399172913358) * r + 5.4637849111641143699) * r + 6.6579046435011037772) /
            (((((((2.04426310338993978564e-15 * r + 1.4215117583164458887e-7) * r + 1.8463183175100546818e-5) * r + 7.868691311456132591e-4) * r + 0.0148753612908506148525) * r +
               0.13692988092273580531) * r + 0.59983220655588793769) * r + 1.0);
  }
  return q < 0.0 ? -value : value;
}

namespace {

constexpr double kNormal = 1e4;

/// Beyond kNormal: the third cumulant of a Poisson distribution is its mean.
double ofNormal(double mean, double z) {
  const double root = std::sqrt(mean);
  return std::max(0.0, std::round(mean + root * z + (z * z - 1.0) / 6.0));
}

}  // namespace

NoiseSource::Drawn NoiseSource::poissonAndNormal(double mean, std::uint32_t place) const {
  const auto [u, v] = pair(place, 0);
  const double z = normalQuantile(v);
  // What is drawn by trials has numbers of its own from the second on.
  return {mean > kNormal ? ofNormal(mean, normalQuantile(u)) : poisson(mean, place ^ 0x80000000u), z};
}

double NoiseSource::poisson(double mean, std::uint32_t place) const {
  constexpr double kInverted = 10.0;
  if (!(mean > 0.0)) return 0.0;
  if (mean < kInverted) {
    double left = uniform(place), term = std::exp(-mean);
    int k = 0;
    for (; left > term && k < 200; ++k) left -= term, term *= mean / (k + 1);
    return k;
  }
  if (mean > kNormal) return ofNormal(mean, normalQuantile(uniform(place)));
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
