#include "sensors/plane_transform.hpp"

#include <algorithm>
#include <unsupported/Eigen/FFT>

#include "sensors/side_by_side.hpp"

namespace pitviper {
namespace {

using Fft = Eigen::FFT<double>;
Fft unscaled() { return Fft(Fft::impl_type(), Fft::Unscaled); }

/// Of factors 2, 3 and 5.
int smoothFrom(int n) {
  for (;; ++n) {
    int left = n;
    for (int p : {2, 3, 5})
      while (left % p == 0) left /= p;
    if (left == 1) return n;
  }
}

}  // namespace

PlaneTransform::PlaneTransform(int leastColumns, int leastRows)
    : columns_(smoothFrom(leastColumns)), rows_(smoothFrom((leastRows + 1) / 2) * 2), half_(columns_ / 2 + 1) {}  // rows go in pairs

std::vector<PlaneTransform::Complex> PlaneTransform::spectrum(const std::vector<double>& plane) const {
  const auto columns = static_cast<std::size_t>(columns_), half = static_cast<std::size_t>(half_);
  std::vector<Complex> all(half * static_cast<std::size_t>(rows_));
  // Two rows in one: the first is the even part of what comes out, the second the odd.
  sideBySide(rows_ / 2, [&](int first, int last) {
    auto fft = unscaled();
    std::vector<Complex> from(columns), into(columns);
    for (auto pair = static_cast<std::size_t>(first); pair < static_cast<std::size_t>(last); ++pair) {
      const double *a = plane.data() + 2 * pair * columns, *b = a + columns;
      for (std::size_t x = 0; x < columns; ++x) from[x] = {a[x], b[x]};
      fft.fwd(into.data(), from.data(), columns_);
      for (std::size_t x = 0; x < half; ++x) {
        const Complex z = into[x], w = std::conj(into[x == 0 ? 0 : columns - x]);
        all[2 * pair * half + x] = 0.5 * (z + w);
        all[(2 * pair + 1) * half + x] = Complex(0.0, -0.5) * (z - w);
      }
    }
  });
  alongColumns(all, false);
  return all;
}

std::vector<double> PlaneTransform::plane(std::vector<Complex> spectrum) const {
  alongColumns(spectrum, true);
  const auto columns = static_cast<std::size_t>(columns_), half = static_cast<std::size_t>(half_);
  std::vector<double> all(columns * static_cast<std::size_t>(rows_));
  sideBySide(rows_ / 2, [&](int first, int last) {
    auto fft = unscaled();
    std::vector<Complex> from(columns), into(columns);
    for (auto pair = static_cast<std::size_t>(first); pair < static_cast<std::size_t>(last); ++pair) {
      const Complex *a = spectrum.data() + 2 * pair * half, *b = a + half;
      for (std::size_t x = 0; x < columns; ++x) {
        const std::size_t at = x < half ? x : columns - x;
        const Complex p = x < half ? a[at] : std::conj(a[at]), q = x < half ? b[at] : std::conj(b[at]);
        from[x] = p + Complex(-q.imag(), q.real());
      }
      fft.inv(into.data(), from.data(), columns_);
      for (std::size_t x = 0; x < columns; ++x) all[2 * pair * columns + x] = into[x].real(), all[(2 * pair + 1) * columns + x] = into[x].imag();
    }
  });
  return all;
}

void PlaneTransform::alongColumns(std::vector<Complex>& spectrum, bool back) const {
  constexpr int kTogether = 8;  // as many of a row as one line of a cache holds twice
  const auto half = static_cast<std::size_t>(half_), rows = static_cast<std::size_t>(rows_);
  sideBySide((half_ + kTogether - 1) / kTogether, [&](int first, int last) {
    auto fft = unscaled();
    std::vector<Complex> from(rows * kTogether), into(rows);
    for (int block = first; block < last; ++block) {
      const auto begin = static_cast<std::size_t>(block) * kTogether, count = std::min<std::size_t>(kTogether, half - begin);
      for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < count; ++x) from[x * rows + y] = spectrum[y * half + begin + x];
      for (std::size_t x = 0; x < count; ++x) {
        if (back) fft.inv(into.data(), from.data() + x * rows, rows_);
        else fft.fwd(into.data(), from.data() + x * rows, rows_);
        std::copy(into.begin(), into.end(), from.begin() + static_cast<std::ptrdiff_t>(x * rows));
      }
      for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < count; ++x) spectrum[y * half + begin + x] = from[x * rows + y];
    }
  });
}

std::vector<double> PlaneTransform::transferOf(const std::vector<double>& kernel) const {
  std::vector<double> transfer;
  for (const Complex& c : spectrum(kernel)) transfer.push_back(c.real() / static_cast<double>(size()));
  return transfer;
}

std::vector<double> PlaneTransform::convolved(const std::vector<double>& plane, const std::vector<double>& transfer) const {
  std::vector<Complex> all = spectrum(plane);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] *= transfer[k];
  return this->plane(std::move(all));
}

}  // namespace pitviper
