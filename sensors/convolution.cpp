#include "sensors/convolution.hpp"

#include <algorithm>
#include <unsupported/Eigen/FFT>

#include "sensors/side_by_side.hpp"

namespace pitviper {
namespace {

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
    : width_(width), height_(height), columns_(smoothFrom(std::max(width, 2 * kernel.reach + 1))), rows_(smoothFrom(std::max(height, 2 * kernel.reach + 1))) {
  std::vector<Complex> plane(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int j = -kernel.reach; j <= kernel.reach; ++j)
    for (int i = -kernel.reach; i <= kernel.reach; ++i)
      plane[static_cast<std::size_t>((j + rows_) % rows_) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>((i + columns_) % columns_)] =
          kernel.at(i, j);
  transform(plane, false);
  for (const Complex& c : plane) transfer_.push_back(c.real() / static_cast<double>(plane.size()));
}

/// Rows, then columns; neither way scaled.
void Convolution::transform(std::vector<Complex>& plane, bool back) const {
  const auto columns = static_cast<std::size_t>(columns_), rows = static_cast<std::size_t>(rows_);
  const auto one = [back](Eigen::FFT<double>& fft, Complex* into, const Complex* from, int n) {
    if (back) fft.inv(into, from, n);
    else fft.fwd(into, from, n);
  };
  const auto plan = [] { return Eigen::FFT<double>(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::Unscaled); };
  sideBySide(rows_, [&](int first, int last) {
    auto fft = plan();
    std::vector<Complex> row(columns);
    for (int y = first; y < last; ++y) {
      Complex* own = plane.data() + static_cast<std::size_t>(y) * columns;
      one(fft, row.data(), own, columns_);
      std::copy(row.begin(), row.end(), own);
    }
  });
  sideBySide(columns_, [&](int first, int last) {
    auto fft = plan();
    std::vector<Complex> from(rows), into(rows);
    for (int x = first; x < last; ++x) {
      for (std::size_t y = 0; y < rows; ++y) from[y] = plane[y * columns + static_cast<std::size_t>(x)];
      one(fft, into.data(), from.data(), rows_);
      for (std::size_t y = 0; y < rows; ++y) plane[y * columns + static_cast<std::size_t>(x)] = into[y];
    }
  });
}

void Convolution::apply(std::vector<float>& picture) const {
  const auto columns = static_cast<std::size_t>(columns_), width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<Complex> plane(transfer_.size());
  // Beyond the picture its edge goes on.
  for (std::size_t y = 0; y < static_cast<std::size_t>(rows_); ++y)
    for (std::size_t x = 0; x < columns; ++x) plane[y * columns + x] = static_cast<double>(picture[std::min(y, height - 1) * width + std::min(x, width - 1)]);
  transform(plane, false);
  for (std::size_t k = 0; k < plane.size(); ++k) plane[k] *= transfer_[k];
  transform(plane, true);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) picture[y * width + x] = static_cast<float>(std::max(0.0, plane[y * columns + x].real()));
}

}  // namespace pitviper
