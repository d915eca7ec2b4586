#include "sim/scene/fourier.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace pitviper {
namespace {

using Complex = std::complex<double>;

/// exp(2 pi i j / n), j below n / 2.
std::vector<Complex> rootsOf(std::size_t n) {
  std::vector<Complex> roots(n / 2);
  for (std::size_t j = 0; j < roots.size(); ++j) roots[j] = std::polar(1.0, 2.0 * 3.14159265358979323846 * static_cast<double>(j) / static_cast<double>(n));
  return roots;
}

/// Cooley and Tukey (1965), radix 2, in place.
void transform(Complex* x, std::size_t n, const std::vector<Complex>& roots) {
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t half = 1; half < n; half *= 2)
    for (std::size_t start = 0; start < n; start += 2 * half)
      for (std::size_t j = 0; j < half; ++j) {
        // By hand: operator* of std::complex looks for NaN.
        const Complex w = roots[j * (n / (2 * half))], a = x[start + j], b = x[start + j + half];
        const Complex t(w.real() * b.real() - w.imag() * b.imag(), w.real() * b.imag() + w.imag() * b.real());
        x[start + j] = a + t;
        x[start + j + half] = a - t;
      }
}

void requirePower(std::size_t n) {
  if (n == 0 || (n & (n - 1)) != 0) throw std::invalid_argument("a Fourier sum needs a power of two");
}

}  // namespace

void fourierSum(std::vector<Complex>& values) {
  requirePower(values.size());
  transform(values.data(), values.size(), rootsOf(values.size()));
}

void fourierSumSquare(std::vector<Complex>& values, int points) {
  const auto n = static_cast<std::size_t>(points);
  requirePower(n);
  if (values.size() != n * n) throw std::invalid_argument("a square has as many rows as columns");
  const auto roots = rootsOf(n);
  for (int axis = 0; axis < 2; ++axis) {
    for (std::size_t row = 0; row < n; ++row) transform(values.data() + row * n, n, roots);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = j + 1; i < n; ++i) std::swap(values[j * n + i], values[i * n + j]);
  }
}

}  // namespace pitviper
