#include "sim/radiometry/harmonics.hpp"

#include <cmath>
#include <vector>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

void realHarmonics(const glm::dvec3& d, int order, std::span<double> into) {
  // P_l^m(z) = sin^m(theta) q_l^m(z); sin^m(theta) (cos, sin)(m phi) = Re, Im of (x + iy)^m.
  double c = 1.0, s = 0.0, qmm = 1.0;
  for (int m = 0; m <= order; ++m) {
    double factorials = 1.0;  // (l - m)! / (l + m)!
    for (int k = 1; k <= 2 * m; ++k) factorials /= k;
    double before = 0.0, q = qmm;
    for (int l = m; l <= order; ++l) {
      const double size = std::sqrt((2 * l + 1) / (4.0 * kPi) * factorials) * q;
      const auto at = static_cast<size_t>(l * l + l);
      if (m == 0) into[at] = size;
      else into[at + static_cast<size_t>(m)] = std::sqrt(2.0) * size * c, into[at - static_cast<size_t>(m)] = std::sqrt(2.0) * size * s;
      const double next = ((2 * l + 1) * d.z * q - (l + m) * before) / (l - m + 1);
      before = q, q = next;
      factorials *= static_cast<double>(l - m + 1) / (l + m + 1);
    }
    qmm *= 2 * m + 1;
    const double turned = d.x * c - d.y * s;
    s = d.x * s + d.y * c, c = turned;
  }
}

namespace {

/// For each degree the inverse of Y_lm(a_k), row by row.
std::array<std::vector<double>, kMostHarmonicOrder + 1> inverses() {
  std::array<std::vector<double>, kMostHarmonicOrder + 1> all;
  for (size_t l = 0; l < all.size(); ++l) {
    const size_t n = l + 1;
    std::vector<double> a(n * n), inverse(n * n, 0.0);
    for (size_t k = 0; k < n; ++k) {
      Harmonics y;
      realHarmonics({std::sin(kPi * kPlaneTurns[k]), 0.0, std::cos(kPi * kPlaneTurns[k])}, kMostHarmonicOrder, y);
      for (size_t m = 0; m < n; ++m) a[m * n + k] = y[l * l + l + m];
      inverse[k * n + k] = 1.0;
    }
    // Gauss and Jordan, with the largest pivot of the column.
    for (size_t c = 0; c < n; ++c) {
      size_t best = c;
      for (size_t r = c + 1; r < n; ++r)
        if (std::abs(a[r * n + c]) > std::abs(a[best * n + c])) best = r;
      for (size_t k = 0; k < n; ++k) std::swap(a[c * n + k], a[best * n + k]), std::swap(inverse[c * n + k], inverse[best * n + k]);
      const double pivot = a[c * n + c];
      for (size_t k = 0; k < n; ++k) a[c * n + k] /= pivot, inverse[c * n + k] /= pivot;
      for (size_t r = 0; r < n; ++r) {
        const double f = r == c ? 0.0 : a[r * n + c];
        for (size_t k = 0; k < n; ++k) a[r * n + k] -= f * a[c * n + k], inverse[r * n + k] -= f * inverse[c * n + k];
      }
    }
    all[l] = std::move(inverse);
  }
  return all;
}

}  // namespace

std::array<double, kPlaneWeights> planeWeights(const std::array<double, kPlaneWeights>& even) {
  static const auto kInverse = inverses();
  std::array<double, kPlaneWeights> w{};
  for (int l = 0; l <= kMostHarmonicOrder; ++l)
    for (int k = 0; k <= l; ++k)
      for (int m = 0; m <= l; ++m)
        w[static_cast<size_t>(planeWeightAt(l, k))] +=
            kInverse[static_cast<size_t>(l)][static_cast<size_t>(k * (l + 1) + m)] * even[static_cast<size_t>(planeWeightAt(l, m))];
  return w;
}

}  // namespace pitviper
