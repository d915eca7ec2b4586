#include "sensors/noise_source.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/wide_loops.hpp"

namespace pitviper {
namespace {

/// AS 241 for |u - 1/2| <= 0.425.
inline double quantileOfMiddle(double q) {
  const double r = 0.180625 - q * q;
  return q *
         (((((((2509.0809287301226727 * r + 33430.575583588128105) * r + 67265.770927008700853) * r + 45921.953931549871457) * r + 13731.693765509461125) * r +
            1971.5909503065514427) * r + 133.14166789178437745) * r + 3.387132872796366608) /
         (((((((5226.495278852545925 * r + 28729.085735721942674) * r + 39307.89580009271061) * r + 21213.794301586595867) * r + 5394.1960214247511077) * r +
            687.1870074920579083) * r + 42.313330701600911252) * r + 1.0);
}

constexpr double kMiddle = 0.425;

/// In (0, 1), of 52 bits.
inline double unitOf(std::uint32_t high, std::uint32_t low) { return (static_cast<double>(((std::uint64_t{high} << 32) | low) >> 12) + 0.5) * 0x1p-52; }

constexpr std::size_t kBatch = 64;

/// Philox of places on end, as pairs in (0, 1).
PITVIPER_WIDE void pairsOf(std::uint32_t first, std::uint32_t frame, std::uint32_t effect, std::uint32_t key0, std::uint32_t key1, double* u, double* v,
                           std::size_t count) {
  std::uint32_t c0[kBatch], c1[kBatch], c2[kBatch], c3[kBatch];
  for (std::size_t i = 0; i < count; ++i) c0[i] = first + static_cast<std::uint32_t>(i), c1[i] = 0, c2[i] = frame, c3[i] = effect;
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t a = std::uint64_t{0xD2511F53u} * c0[i], b = std::uint64_t{0xCD9E8D57u} * c2[i];
      c0[i] = static_cast<std::uint32_t>(b >> 32) ^ c1[i] ^ key0;
      c1[i] = static_cast<std::uint32_t>(b);
      c2[i] = static_cast<std::uint32_t>(a >> 32) ^ c3[i] ^ key1;
      c3[i] = static_cast<std::uint32_t>(a);
    }
    key0 += 0x9E3779B9u, key1 += 0xBB67AE85u;
  }
  for (std::size_t i = 0; i < count; ++i) {
    // 52 bits below a power of two become a double without a conversion, which no register of integers has.
    const std::uint64_t a = ((std::uint64_t{c0[i]} << 32) | c1[i]) >> 12, b = ((std::uint64_t{c2[i]} << 32) | c3[i]) >> 12;
    u[i] = (std::bit_cast<double>(a | 0x4330000000000000u) - 0x1p52 + 0.5) * 0x1p-52;
    v[i] = (std::bit_cast<double>(b | 0x4330000000000000u) - 0x1p52 + 0.5) * 0x1p-52;
  }
}

PITVIPER_WIDE void middleQuantiles(const double* u, double* z, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) z[i] = quantileOfMiddle(u[i] - 0.5);
}

/// round() of what is not negative and below 2^52, as it is defined: halves away from zero.
inline double rounded(double x) {
  const double whole = (x + 0x1p52) - 0x1p52;  // halves to even
  return whole + (x - whole == 0.5 ? 1.0 : 0.0);
}

PITVIPER_WIDE void countsOfNormals(double* mean, const double* z, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const double x = mean[i] + std::sqrt(mean[i]) * z[i] + (z[i] * z[i] - 1.0) / 6.0;
    mean[i] = rounded(x > 0.0 ? x : 0.0);
  }
}

}  // namespace

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
  return {unitOf(bits[0], bits[1]), unitOf(bits[2], bits[3])};
}

double NoiseSource::uniform(std::uint32_t place, std::uint32_t draw) const { return pair(place, draw)[0]; }

double NoiseSource::normal(std::uint32_t place, std::uint32_t draw) const {
  const auto [u, v] = pair(place, draw);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

double normalQuantile(double u) {
  const double q = u - 0.5;
  if (std::abs(q) <= kMiddle) return quantileOfMiddle(q);
  double r = std::sqrt(-std::log(q < 0.0 ? u : 1.0 - u)), value;
  if (r <= 5.0) {
    r -= 1.6;
    value = (((((((7.7454501427834140764e-4 * r + 0.0227238449892691845833) * r + 0.24178072517745061177) * r + 1.27045825245236838258) * r +
                3.64784832476320460504) *
                   r +
               5.7694972214606914055) *
                  r +
              4.6303378461565452959) *
                 r +
             1.42343711074968357734) /
            (((((((1.05075007164441684324e-9 * r + 5.475938084995344946e-4) * r + 0.0151986665636164571966) * r + 0.14810397642748007459) * r +
                0.68976733498510000455) *
                   r +
               1.6763848301838038494) *
                  r +
              2.05319162663775882187) *
                 r +
             1.0);
  } else {
    r -= 5.0;
    value = (((((((2.01033439929228813265e-7 * r + 2.71155556874348757815e-5) * r + 0.0012426609473880784386) * r + 0.026532189526576123093) * r +
                0.29656057182850489123) *
                   r +
               1.7848265399172913358) *
                  r +
              5.4637849111641143699) *
                 r +
             6.6579046435011037772) /
            (((((((2.04426310338993978564e-15 * r + 1.4215117583164458887e-7) * r + 1.8463183175100546818e-5) * r + 7.868691311456132591e-4) * r +
                0.0148753612908506148525) *
                   r +
               0.13692988092273580531) *
                  r +
              0.59983220655588793769) *
                 r +
             1.0);
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

void normalQuantiles(std::span<double> u) {
  double given[kBatch];
  for (std::size_t from = 0; from < u.size(); from += kBatch) {
    const std::size_t count = std::min(kBatch, u.size() - from);
    std::copy_n(u.begin() + static_cast<std::ptrdiff_t>(from), count, given);
    middleQuantiles(given, &u[from], count);
    for (std::size_t i = 0; i < count; ++i)
      if (!(std::abs(given[i] - 0.5) <= kMiddle)) u[from + i] = normalQuantile(given[i]);
  }
}

void NoiseSource::poissonAndNormal(std::uint32_t first, std::span<double> mean, std::span<double> normal) const {
  double u[kBatch];
  for (std::size_t from = 0; from < mean.size(); from += kBatch) {
    const std::size_t count = std::min(kBatch, mean.size() - from);
    const auto place = first + static_cast<std::uint32_t>(from);
    pairsOf(place, frame_, effect_, key_[0], key_[1], u, &normal[from], count);
    normalQuantiles(normal.subspan(from, count));
    const auto means = mean.subspan(from, count);
    if (std::all_of(means.begin(), means.end(), [](double m) { return m > kNormal; })) {
      normalQuantiles({u, count});
      countsOfNormals(means.data(), u, count);
      continue;
    }
    for (std::size_t i = 0; i < count; ++i)
      means[i] = means[i] > kNormal ? ofNormal(means[i], normalQuantile(u[i])) : poisson(means[i], (place + static_cast<std::uint32_t>(i)) ^ 0x80000000u);
  }
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
