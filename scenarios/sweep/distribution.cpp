#include "scenarios/sweep/distribution.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/noise_source.hpp"

namespace pitviper {
namespace {

/// The largest double below 1: a quantile of 1 would not be finite.
constexpr double kBelowOne = 1.0 - 0x1p-53;

double normalShareBelow(double z) { return 0.5 * std::erfc(-z * std::sqrt(0.5)); }

/// Of a standard normal distribution within [from, to], from <= 0 or nearly so: shares below are then exact.
double lowerQuantile(double from, double to, double u) {
  const double p = std::lerp(normalShareBelow(from), normalShareBelow(to), u);
  return std::clamp(normalQuantile(std::clamp(p, std::numeric_limits<double>::min(), kBelowOne)), from, to);
}

}  // namespace

double normalShare(double mean, double sigma, double low, double high) {
  const double from = (low - mean) / sigma, to = (high - mean) / sigma;
  return from > 0.0 ? normalShareBelow(-from) - normalShareBelow(-to) : normalShareBelow(to) - normalShareBelow(from);
}

Distribution Distribution::uniform(double low, double high) {
  Distribution d;
  d.low_ = low, d.high_ = high;
  return d;
}

Distribution Distribution::logUniform(double low, double high) {
  Distribution d = uniform(low, high);
  d.kind_ = Kind::LogUniform;
  return d;
}

Distribution Distribution::normal(double mean, double sigma, double low, double high) {
  Distribution d = uniform(low, high);
  d.kind_ = Kind::Normal;
  d.mean_ = mean, d.sigma_ = sigma;
  return d;
}

Distribution Distribution::oneOf(std::vector<double> values, const std::vector<double>& weights) {
  Distribution d;
  d.kind_ = Kind::OneOf;
  d.values_ = std::move(values);
  double sum = 0.0;
  for (double w : weights) d.cumulative_.push_back(sum += w);
  for (double& share : d.cumulative_) share /= sum;
  return d;
}

double Distribution::quantile(double u) const {
  switch (kind_) {
    case Kind::Uniform:
      return std::lerp(low_, high_, u);
    case Kind::LogUniform:
      return std::clamp(std::exp(std::lerp(std::log(low_), std::log(high_), u)), low_, high_);
    case Kind::Normal: {
      const double from = (low_ - mean_) / sigma_, to = (high_ - mean_) / sigma_;
      // The upper tail by its mirror image: shares near 1 have no digits left.
      const double z = from > 0.0 ? -lowerQuantile(-to, -from, 1.0 - u) : lowerQuantile(from, to, u);
      return std::clamp(mean_ + sigma_ * z, low_, high_);
    }
    case Kind::OneOf: {
      if (cumulative_.empty()) return values_[std::min(static_cast<std::size_t>(u * static_cast<double>(values_.size())), values_.size() - 1)];
      const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
      return values_[static_cast<std::size_t>(found - cumulative_.begin())];
    }
  }
  return 0.0;
}

}  // namespace pitviper
