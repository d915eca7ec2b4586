#include "scenarios/view/display_scale.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/image/picture_scale.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// A logarithmic bar spans so much at most where values reach down to 0.
constexpr double kDecades = 1e6;
constexpr std::size_t kQuantiles = 64;

std::vector<float> finite(const std::vector<float>& pixels) {
  std::vector<float> some;
  some.reserve(pixels.size());
  for (float v : pixels)
    if (std::isfinite(v)) some.push_back(v);
  return some;
}

/// An even choice of pixels that is large enough for a percentile, of pictures that come one after another.
std::vector<float> everySome(const std::vector<float>& pixels) {
  constexpr std::size_t kEnough = 20000;
  const std::size_t step = 1 + pixels.size() / kEnough;
  std::vector<float> some;
  for (std::size_t k = 0; k < pixels.size(); k += step) some.push_back(pixels[k]);
  return some;
}

double quantile(std::vector<float>& v, double share) {
  const auto at = v.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

}  // namespace

const char* nameOf(ScaleKind kind) { return kind == ScaleKind::Linear ? "linear" : kind == ScaleKind::Logarithmic ? "logarithmic" : "histogram"; }

std::pair<double, double> DisplayScale::endsOf(const std::vector<float>& pixels) {
  std::vector<float> some = finite(everySome(pixels));
  if (some.empty()) return {0.0, 1.0};
  double low = quantile(some, 0.005), high = quantile(some, 0.998);
  if (isNearlySame(low, high)) {
    const std::vector<float> all = finite(pixels);
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    low = *least, high = *most;
  }
  return {low, high};
}

DisplayScale::DisplayScale(ScaleKind kind, double low, double high, const std::vector<float>& pixels) : kind_(kind), low_(low), high_(high) {
  if (isNearlySame(low_, high_) || high_ < low_) {
    const double half = std::max(0.5e-3 * std::abs(low_), 1e-12);
    high_ = low_ + half, low_ -= half;
  }
  if (kind_ == ScaleKind::Logarithmic) {
    if (high_ <= 0.0) high_ = 1.0;
    low_ = std::clamp(low_, high_ / kDecades, high_ * 0.999);
  }
  if (kind_ != ScaleKind::Histogram) return;
  std::vector<float> some = finite(pixels);
  std::erase_if(some, [&](float v) { return v < low_ || v > high_; });
  if (some.size() < kQuantiles) {
    kind_ = ScaleKind::Linear;
    return;
  }
  std::sort(some.begin(), some.end());
  for (std::size_t k = 0; k <= kQuantiles; ++k) quantiles_.push_back(some[k * (some.size() - 1) / kQuantiles]);
}

double DisplayScale::position(double value) const {
  if (!std::isfinite(value)) return value > 0.0 ? 1.0 : 0.0;
  if (kind_ == ScaleKind::Linear) return std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
  if (kind_ == ScaleKind::Logarithmic) return value <= low_ ? 0.0 : std::clamp(std::log(value / low_) / std::log(high_ / low_), 0.0, 1.0);
  const auto above = std::upper_bound(quantiles_.begin(), quantiles_.end(), value);
  if (above == quantiles_.begin()) return 0.0;
  if (above == quantiles_.end()) return 1.0;
  const double from = *(above - 1), part = *above > from ? (value - from) / (*above - from) : 0.0;
  return (static_cast<double>(above - quantiles_.begin() - 1) + part) / static_cast<double>(kQuantiles);
}

double DisplayScale::value(double position) const {
  const double p = std::clamp(position, 0.0, 1.0);
  if (kind_ == ScaleKind::Linear) return low_ + p * (high_ - low_);
  if (kind_ == ScaleKind::Logarithmic) return low_ * std::pow(high_ / low_, p);
  const double along = p * static_cast<double>(kQuantiles);
  const auto k = std::min(static_cast<std::size_t>(along), kQuantiles - 1);
  return quantiles_[k] + (along - static_cast<double>(k)) * (quantiles_[k + 1] - quantiles_[k]);
}

std::vector<std::pair<double, std::string>> DisplayScale::ticks() const {
  std::vector<std::pair<double, std::string>> all;
  if (kind_ == ScaleKind::Linear) {
    const Ticks t = chooseTicks(low_, high_);
    for (std::size_t k = 0; k < t.values.size(); ++k) all.emplace_back(t.values[k], t.labels[k] + powerText(t.power));
  } else if (kind_ == ScaleKind::Logarithmic && high_ / low_ > 30.0) {
    for (int power = static_cast<int>(std::ceil(std::log10(low_))); power <= static_cast<int>(std::floor(std::log10(high_))); ++power)
      all.emplace_back(std::pow(10.0, power), print("1e%d", power));
  } else {
    constexpr int kSteps = 5;
    for (int k = 0; k <= kSteps; ++k) {
      const double v = value(static_cast<double>(k) / kSteps);
      all.emplace_back(v, shortNumber(v));
    }
  }
  return all;
}

}  // namespace pitviper
