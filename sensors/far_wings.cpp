#include "sensors/far_wings.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/side_by_side.hpp"

namespace pitviper {
namespace {

/// Steps of the grid in the distance over which what is near gives way: Lagrange's cubic is then within 1e-3 of it.
constexpr double kSteps = 8.0;
/// Nodes before the first cell and behind the last.
constexpr int kBefore = 2, kMore = 5;

}  // namespace

FarWings::FarWings(const LensSpread& spread, int width, int height)
    : width_(width),
      height_(height),
      step_(std::max(1, static_cast<int>((spread.cut.end - spread.cut.begin) / kSteps))),
      columns_(width / step_ + kMore),
      rows_(height / step_ + kMore),
      transform_(2 * columns_, 2 * rows_) {
  const int across = transform_.columns(), down = transform_.rows();
  std::vector<double> kernel(transform_.size(), 0.0);
  for (int j = -rows_ + 1; j < rows_; ++j)
    for (int i = -columns_ + 1; i < columns_; ++i)
      if (const double r = step_ * std::hypot(i, j); r > spread.cut.begin)
        kernel[static_cast<std::size_t>((j + down) % down) * static_cast<std::size_t>(across) + static_cast<std::size_t>((i + across) % across)] =
            (1.0 - spread.cut(r)) * spread.far(r);
  transfer_ = transform_.transferOf(kernel);
  light_.assign(transform_.size(), 0.0);
  for (int x = 0; x < width; ++x) ofColumn_.push_back(placeOf(x + 0.5));
  for (int y = 0; y < height; ++y) ofRow_.push_back(placeOf(y + 0.5));
}

FarWings::Place FarWings::placeOf(double cell) const {
  const double at = cell / step_ + kBefore, below = std::floor(at), t = at - below;
  return {static_cast<int>(below) - 1,
          {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0, -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0}};
}

void FarWings::gather(const std::vector<float>& picture, double level) {
  const auto across = static_cast<std::size_t>(transform_.columns()), nodes = static_cast<std::size_t>(columns_);
  std::vector<double> rows(nodes * static_cast<std::size_t>(height_), 0.0);
  sideBySide(height_, [&](int first, int last) {
    for (auto y = static_cast<std::size_t>(first); y < static_cast<std::size_t>(last); ++y) {
      const float* cells = &picture[y * static_cast<std::size_t>(width_)];
      double* row = &rows[y * nodes];
      for (std::size_t x = 0; x < ofColumn_.size(); ++x) {
        const double light = static_cast<double>(cells[x]) - level;
        double* to = row + ofColumn_[x].first;
        for (int k = 0; k < 4; ++k) to[k] += ofColumn_[x].weight[k] * light;
      }
    }
  });
  for (std::size_t y = 0; y < ofRow_.size(); ++y)
    for (int k = 0; k < 4; ++k)
      for (std::size_t x = 0; x < nodes; ++x) light_[static_cast<std::size_t>(ofRow_[y].first + k) * across + x] += ofRow_[y].weight[k] * rows[y * nodes + x];
}

void FarWings::gather(double column, double row, double light) {
  const Place across = placeOf(std::clamp(column, 0.0, static_cast<double>(width_))), down = placeOf(std::clamp(row, 0.0, static_cast<double>(height_)));
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      light_[static_cast<std::size_t>(down.first + j) * static_cast<std::size_t>(transform_.columns()) + static_cast<std::size_t>(across.first + i)] +=
          down.weight[j] * across.weight[i] * light;
}

void FarWings::spread(std::vector<double>& cells) {
  const auto across = static_cast<std::size_t>(transform_.columns());
  const std::vector<double> far = transform_.convolved(light_, transfer_);
  std::fill(light_.begin(), light_.end(), 0.0);
  sideBySide(height_, [&](int first, int last) {
    std::vector<double> row(static_cast<std::size_t>(columns_));
    for (int y = first; y < last; ++y) {
      std::fill(row.begin(), row.end(), 0.0);
      const Place& down = ofRow_[static_cast<std::size_t>(y)];
      for (int k = 0; k < 4; ++k)
        for (std::size_t x = 0; x < row.size(); ++x) row[x] += down.weight[k] * far[static_cast<std::size_t>(down.first + k) * across + x];
      double* own = &cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_)];
      for (std::size_t x = 0; x < ofColumn_.size(); ++x) {
        const double *from = row.data() + ofColumn_[x].first, *w = ofColumn_[x].weight;
        own[x] += w[0] * from[0] + w[1] * from[1] + w[2] * from[2] + w[3] * from[3];
      }
    }
  });
}

}  // namespace pitviper
