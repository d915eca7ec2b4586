#include "sensors/convolution.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "sensors/side_by_side.hpp"

namespace pitviper {
namespace {

using Fft = Eigen::FFT<double>;
Fft unscaled() { return Fft(Fft::impl_type(), Fft::Unscaled); }

/// Longer ones are faster by spectra.
constexpr int kLongest = 24;

/// The kernel along a row, and along a column, if all of it is their product: to what a transfer function's table leaves of that.
std::vector<double> factorOf(const SpreadKernel& k) {
  constexpr double kProduct = 1e-5;
  if (k.reach > kLongest || !(k.at(0, 0) > 0.0)) return {};
  for (int j = 0; j <= k.reach; ++j)
    for (int i = 0; i <= k.reach; ++i)
      if (std::abs(k.at(i, j) * k.at(0, 0) - k.at(i, 0) * k.at(0, j)) > kProduct * k.at(0, 0) * k.at(0, 0)) return {};
  std::vector<double> along;
  for (int i = 0; i <= k.reach; ++i) along.push_back(k.at(i, 0) / std::sqrt(k.at(0, 0)));
  return along;
}

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

Convolution::Convolution(const SpreadKernel& kernel, int width, int height)
    : along_(factorOf(kernel)),
      width_(width),
      height_(height),
      columns_(smoothFrom(std::max(width, 2 * kernel.reach + 1))),
      rows_(smoothFrom((std::max(height, 2 * kernel.reach + 1) + 1) / 2) * 2),  // rows go in pairs
      half_(columns_ / 2 + 1) {
  if (!along_.empty()) return;
  std::vector<double> own(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int j = -kernel.reach; j <= kernel.reach; ++j)
    for (int i = -kernel.reach; i <= kernel.reach; ++i)
      own[static_cast<std::size_t>((j + rows_) % rows_) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>((i + columns_) % columns_)] =
          kernel.at(i, j);
  for (const Complex& c : spectrum(own)) transfer_.push_back(c.real() / static_cast<double>(own.size()));
}

std::vector<Convolution::Complex> Convolution::spectrum(const std::vector<double>& plane) const {
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
  this->columns(all, false);
  return all;
}

std::vector<double> Convolution::plane(std::vector<Complex> spectrum) const {
  columns(spectrum, true);
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

void Convolution::columns(std::vector<Complex>& spectrum, bool back) const {
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

void Convolution::applyAlong(std::vector<float>& picture) const {
  const int reach = static_cast<int>(along_.size()) - 1;
  const auto width = static_cast<std::size_t>(width_), padded = width + 2 * static_cast<std::size_t>(reach);
  std::vector<double> rows(picture.size());
  sideBySide(height_, [&](int first, int last) {
    std::vector<double> row(padded);
    for (auto y = static_cast<std::size_t>(first); y < static_cast<std::size_t>(last); ++y) {
      for (std::size_t x = 0; x < padded; ++x)
        row[x] = static_cast<double>(picture[y * width + static_cast<std::size_t>(std::clamp(static_cast<int>(x) - reach, 0, width_ - 1))]);
      const double* middle = row.data() + reach;
      double* out = &rows[y * width];
      for (std::size_t x = 0; x < width; ++x) out[x] = along_[0] * middle[x];
      for (int k = 1; k <= reach; ++k)
        for (std::size_t x = 0; x < width; ++x) out[x] += along_[static_cast<std::size_t>(k)] * (middle[static_cast<std::ptrdiff_t>(x) - k] + middle[x + static_cast<std::size_t>(k)]);
    }
  });
  sideBySide(height_, [&](int first, int last) {
    std::vector<double> sum(width);
    for (int y = first; y < last; ++y) {
      const auto rowAt = [&](int at) { return &rows[static_cast<std::size_t>(std::clamp(at, 0, height_ - 1)) * width]; };
      const double* own = rowAt(y);
      for (std::size_t x = 0; x < width; ++x) sum[x] = along_[0] * own[x];
      for (int k = 1; k <= reach; ++k) {
        const double *above = rowAt(y - k), *below = rowAt(y + k);
        for (std::size_t x = 0; x < width; ++x) sum[x] += along_[static_cast<std::size_t>(k)] * (above[x] + below[x]);
      }
      for (std::size_t x = 0; x < width; ++x) picture[static_cast<std::size_t>(y) * width + x] = static_cast<float>(std::max(0.0, sum[x]));
    }
  });
}

void Convolution::apply(std::vector<float>& picture) const {
  if (!along_.empty()) return applyAlong(picture);
  const auto columns = static_cast<std::size_t>(columns_), width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<double> whole(columns * static_cast<std::size_t>(rows_));
  // Beyond the picture its edge goes on.
  for (std::size_t y = 0; y < static_cast<std::size_t>(rows_); ++y)
    for (std::size_t x = 0; x < columns; ++x) whole[y * columns + x] = static_cast<double>(picture[std::min(y, height - 1) * width + std::min(x, width - 1)]);
  std::vector<Complex> all = spectrum(whole);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] *= transfer_[k];
  whole = plane(std::move(all));
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) picture[y * width + x] = static_cast<float>(std::max(0.0, whole[y * columns + x]));
}

}  // namespace pitviper
