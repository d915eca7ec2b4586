#include "scenarios/commands/charts/axis_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/image/ticks.hpp"

namespace pitviper {
namespace {

/// Free room at an end of an axis, part of its length: a marker is not cut in half.
constexpr double kMargin = 0.05;

/// 1, 2, 5 in every decade, or decades alone where these would be crowded; `low` and `high` are logarithms.
std::vector<double> logarithmicTicks(double low, double high) {
  const bool crowded = high - low > 3.0;
  std::vector<double> ticks;
  for (int decade = static_cast<int>(std::floor(low)); decade <= static_cast<int>(std::ceil(high)); ++decade)
    for (int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, decade);
      if ((digit == 1 || !crowded) && std::log10(value) >= low && std::log10(value) <= high) ticks.push_back(value);
    }
  return ticks;
}

}  // namespace

double axisCoordinate(double value, bool logarithmic) {
  if (!std::isfinite(value) || (logarithmic && value <= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return logarithmic ? std::log10(value) : value;
}

AxisLayout layOutAxis(const std::vector<double>& values, bool logarithmic, const std::vector<double>& ticks, Zero zero) {
  AxisLayout axis;
  double low = INFINITY, high = -INFINITY;
  for (double value : values)
    if (const double at = axisCoordinate(value, logarithmic); !std::isnan(at)) low = std::min(low, at), high = std::max(high, at);
  if (low > high) low = 0.0, high = 1.0;
  const bool fromZero = !logarithmic && low >= 0.0 && (zero == Zero::Always || (zero == Zero::IfNear && low < 0.5 * high));
  if (fromZero) low = 0.0;
  if (low == high) low -= std::max(0.5, 0.1 * std::abs(low)), high += std::max(0.5, 0.1 * std::abs(high));
  const double margin = kMargin * (high - low);
  axis.low = fromZero ? 0.0 : low - margin;
  axis.high = high + margin;

  std::vector<double> wanted = ticks;
  if (wanted.empty() && logarithmic) wanted = logarithmicTicks(axis.low, axis.high);
  if (wanted.empty() || (logarithmic && wanted.size() < 2 && ticks.empty())) {
    const auto value = [&](double at) { return logarithmic ? std::pow(10.0, at) : at; };
    const Ticks round = chooseTicks(value(axis.low), value(axis.high));
    for (double t : round.values) axis.ticks.push_back(axisCoordinate(t, logarithmic));
    axis.labels = round.labels;
    axis.power = powerText(round.power);
    return axis;
  }
  for (double t : wanted) {
    axis.ticks.push_back(axisCoordinate(t, logarithmic));
    axis.labels.push_back(shortNumber(t));
  }
  return axis;
}

AxisLayout layOutCategories(const std::vector<std::string>& categories) {
  AxisLayout axis;
  axis.low = -0.6;
  axis.high = static_cast<double>(categories.size()) - 0.4;
  axis.labels = categories;
  for (size_t i = 0; i < categories.size(); ++i) axis.ticks.push_back(static_cast<double>(i));
  return axis;
}

}  // namespace pitviper
