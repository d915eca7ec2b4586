#include "sim/image/picture_scale.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pitviper {
namespace {

std::pair<double, double> widened(double low, double high) {
  if (!isNearlySame(low, high)) return {low, high};
  if (low == 0 && high == 0) return {0, 1};
  const double middle = 0.5 * low + 0.5 * high;
  const double margin = 0.01 * std::abs(middle);
  return {middle - margin, middle + margin};
}

}  // namespace

bool isNearlySame(double low, double high) { return high - low <= 4e-7 * std::max(std::abs(low), std::abs(high)); }

PictureScale::PictureScale(double low, double high, double centre, double spread)
    : low_(low), high_(high), centre_(centre), spread_(spread), bottom_(std::asinh((low - centre) / spread)), top_(std::asinh((high - centre) / spread)) {}

PictureScale PictureScale::between(double low, double high) {
  const auto [from, to] = widened(low, high);
  return {from, to};
}

PictureScale PictureScale::of(std::vector<float> pixels) {
  std::erase_if(pixels, [](float v) { return !std::isfinite(v); });
  if (pixels.empty()) return {0.0, 1.0};
  const auto percentile = [&](double part) {
    const auto i = static_cast<std::ptrdiff_t>(std::lround(part * static_cast<double>(pixels.size() - 1)));
    std::nth_element(pixels.begin(), pixels.begin() + i, pixels.end());
    return static_cast<double>(pixels[static_cast<std::size_t>(i)]);
  };
  const double low = percentile(0.005), p10 = percentile(0.1), p50 = percentile(0.5), p90 = percentile(0.9), high = percentile(0.998);
  if (isNearlySame(low, high)) {
    // A small hot target on an even background lies wholly outside the percentiles, and is what matters.
    const auto [least, most] = std::minmax_element(pixels.begin(), pixels.end());
    return between(*least, *most);
  }
  const double bulk = 0.5 * (p90 - p10);
  // Linear would give the middle four fifths of the pixels less than an eighth of the bar.
  if (isNearlySame(p10, p90) || high - low < 16.0 * bulk) return {low, high};
  return {low, high, p50, 2.0 * bulk};
}

double PictureScale::position(double value) const {
  if (isLinear()) return (value - low_) / (high_ - low_);
  return (std::asinh((value - centre_) / spread_) - bottom_) / (top_ - bottom_);
}

double PictureScale::value(double position) const {
  if (isLinear()) return low_ + position * (high_ - low_);
  return centre_ + spread_ * std::sinh(bottom_ + position * (top_ - bottom_));
}

void CommonScale::add(const std::vector<float>& pixels) {
  constexpr std::size_t kMost = 4u << 20;
  float least = INFINITY, most = -INFINITY;
  for (float v : pixels)
    if (std::isfinite(v)) least = std::min(least, v), most = std::max(most, v);
  if (least <= most) extremes_.insert(extremes_.end(), {least, most});
  for (std::size_t i = 0; i < pixels.size(); i += step_) some_.push_back(pixels[i]);
  while (some_.size() > kMost) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < some_.size(); i += 2) some_[kept++] = some_[i];
    some_.resize(kept);
    step_ *= 2;
  }
}

PictureScale CommonScale::scale() const {
  const PictureScale scale = PictureScale::of(some_);
  std::vector<float> all = extremes_;
  std::erase_if(all, [](float v) { return !std::isfinite(v); });
  if (all.empty()) return scale;
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  // Even but for what the choice passed over.
  std::vector<float> chosen = some_;
  std::erase_if(chosen, [](float v) { return !std::isfinite(v); });
  const auto [low, high] = std::minmax_element(chosen.begin(), chosen.end());
  return chosen.empty() || isNearlySame(*low, *high) ? PictureScale::between(*least, *most) : scale;
}

}  // namespace pitviper
