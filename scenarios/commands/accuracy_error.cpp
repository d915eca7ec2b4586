#include "scenarios/commands/accuracy_error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/plan/fine_grid.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

constexpr double kSecondRadiation_um_K = 14387.768775039337;

double rank(const std::vector<double>& sorted, double part) { return sorted[static_cast<size_t>(part * static_cast<double>(sorted.size() - 1))]; }

/// Black bodies in a channel, 1 K apart: the change of slope from one to the next is below 3 %, what is interpolated below 1e-4.
struct BlackBodies {
  std::vector<double> radiance, slope;
  double integral = 0.0;  ///< of the kernel

  explicit BlackBodies(const Spectrum& kernel) {
    const auto nodes = fineGrid(kernel);
    for (const auto& n : nodes) integral += n.weight;
    for (double t = ChannelReference::kColdest_K; t <= ChannelReference::kWarmest_K; t += 1.0) {
      double sum = 0.0, derivative = 0.0;
      for (const auto& n : nodes) {
        const double b = n.weight * physics::planckRadiance(n.x, t), x = kSecondRadiation_um_K / (n.x * t);
        sum += b;
        derivative += b * x / (t * physics::oneMinusExp(x));
      }
      radiance.push_back(sum);
      slope.push_back(derivative);
    }
  }
  double slopeAt(double l) const {
    if (!(l >= radiance.front() && l <= radiance.back() && l > 0.0)) return 0.0;
    const auto above = std::upper_bound(radiance.begin() + 1, radiance.end() - 1, l);
    const auto i = static_cast<size_t>(above - radiance.begin()) - 1;
    return slope[i] + (slope[i + 1] - slope[i]) * (l - radiance[i]) / (radiance[i + 1] - radiance[i]);
  }
};

}  // namespace

ErrorFigures figuresOf(std::vector<double>& values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {rank(values, 0.5), rank(values, 0.99), values.back()};
}

ChannelReference::ChannelReference(const Spectrum& kernel, std::vector<double> values) : values_(std::move(values)) {
  std::vector<double> sorted = values_;
  const BlackBodies bodies(kernel);
  floor_ = darkFloor(figuresOf(sorted).percentile99, bodies.integral);
  for (double l : values_) slope_.push_back(bodies.slopeAt(l));
}

std::vector<double> ChannelReference::relative(std::span<const double> rendered) const {
  if (rendered.size() != values_.size()) throw std::invalid_argument("a picture of another size than its reference");
  std::vector<double> all;
  for (size_t p = 0; p < values_.size(); ++p) {
    const double difference = std::abs(rendered[p] - values_[p]), scale = std::max(values_[p], floor_);
    all.push_back(scale > 0.0 ? difference / scale : difference > 0.0 ? INFINITY : 0.0);
  }
  return all;
}

ChannelErrors ChannelReference::errors(std::span<const double> rendered) const {
  std::vector<double> relative = this->relative(rendered), kelvin;
  for (size_t p = 0; p < values_.size(); ++p)
    if (slope_[p] > 0.0) kelvin.push_back(std::abs(rendered[p] - values_[p]) / slope_[p]);
  ChannelErrors errors{figuresOf(relative), {}};
  if (!kelvin.empty()) errors.kelvin = figuresOf(kelvin);
  return errors;
}

}  // namespace pitviper
