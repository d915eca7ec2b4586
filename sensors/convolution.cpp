#include "sensors/convolution.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/side_by_side.hpp"

namespace pitviper {
namespace {

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

}  // namespace

Convolution::Convolution(const SpreadKernel& kernel, int width, int height, int unused)
    : along_(factorOf(kernel)),
      width_(width),
      height_(height),
      transform_(std::max(width + std::max(0, kernel.reach - unused), 2 * kernel.reach + 1),
                 std::max(height + std::max(0, kernel.reach - unused), 2 * kernel.reach + 1)) {
  if (!along_.empty()) return;
  std::vector<double> own(transform_.size());
  const int columns = transform_.columns(), rows = transform_.rows();
  for (int j = -kernel.reach; j <= kernel.reach; ++j)
    for (int i = -kernel.reach; i <= kernel.reach; ++i)
      own[static_cast<std::size_t>((j + rows) % rows) * static_cast<std::size_t>(columns) + static_cast<std::size_t>((i + columns) % columns)] =
          kernel.at(i, j);
  transfer_ = transform_.transferOf(own);
}

std::vector<double> Convolution::alongBoth(const std::vector<float>& picture, double level) const {
  const int reach = static_cast<int>(along_.size()) - 1;
  const auto width = static_cast<std::size_t>(width_), padded = width + 2 * static_cast<std::size_t>(reach);
  std::vector<double> rows(picture.size()), all(picture.size());
  sideBySide(height_, [&](int first, int last) {
    std::vector<double> row(padded, 0.0);
    for (auto y = static_cast<std::size_t>(first); y < static_cast<std::size_t>(last); ++y) {
      for (std::size_t x = 0; x < width; ++x) row[x + static_cast<std::size_t>(reach)] = static_cast<double>(picture[y * width + x]) - level;
      const double* middle = row.data() + reach;
      double* out = &rows[y * width];
      for (std::size_t x = 0; x < width; ++x) out[x] = along_[0] * middle[x];
      for (int k = 1; k <= reach; ++k)
        for (std::size_t x = 0; x < width; ++x)
          out[x] += along_[static_cast<std::size_t>(k)] * (middle[static_cast<std::ptrdiff_t>(x) - k] + middle[x + static_cast<std::size_t>(k)]);
    }
  });
  sideBySide(height_, [&](int first, int last) {
    const std::vector<double> beyond(width, 0.0);
    for (int y = first; y < last; ++y) {
      const auto rowAt = [&](int at) { return at < 0 || at >= height_ ? beyond.data() : &rows[static_cast<std::size_t>(at) * width]; };
      double* sum = &all[static_cast<std::size_t>(y) * width];
      const double* own = rowAt(y);
      for (std::size_t x = 0; x < width; ++x) sum[x] = along_[0] * own[x];
      for (int k = 1; k <= reach; ++k) {
        const double *above = rowAt(y - k), *below = rowAt(y + k);
        for (std::size_t x = 0; x < width; ++x) sum[x] += along_[static_cast<std::size_t>(k)] * (above[x] + below[x]);
      }
    }
  });
  return all;
}

std::vector<double> Convolution::operator()(const std::vector<float>& picture, double level) const {
  if (!along_.empty()) return alongBoth(picture, level);
  const auto columns = static_cast<std::size_t>(transform_.columns()), width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  std::vector<double> whole(transform_.size(), 0.0), spread;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) whole[y * columns + x] = static_cast<double>(picture[y * width + x]) - level;
  whole = transform_.convolved(whole, transfer_);
  spread.reserve(width * height);
  for (std::size_t y = 0; y < height; ++y)
    spread.insert(spread.end(), whole.begin() + static_cast<std::ptrdiff_t>(y * columns), whole.begin() + static_cast<std::ptrdiff_t>(y * columns + width));
  return spread;
}

}  // namespace pitviper
