#include "scenarios/sweep/sweep_axis.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/sweep/svg_drawing.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr double kAxisMargin = 0.04;
constexpr double kMostLogarithmicTicks = 6.0;

/// "0.01", "100", "10⁷".
std::string decadeText(int exponent) {
  constexpr int kLeastPlain = -3, kMostPlain = 4;
  if (exponent >= kLeastPlain && exponent <= kMostPlain) return print("%g", std::pow(10.0, exponent));
  return powerText(exponent).substr(std::string("×").size());
}

/// Of numbers in rising order.
bool crowdsAtTheLowEnd(const std::vector<double>& rising) {
  return rising.front() > 0.0 && rising.back() >= 100.0 * rising.front() && rising[rising.size() / 2] < 0.1 * rising.back();
}

SweepAxis logarithmicAxis(double least, double most) {
  SweepAxis axis;
  axis.isLogarithmic = true;
  const double margin = kAxisMargin * (std::log10(most) - std::log10(least));
  axis.low = std::log10(least) - margin, axis.high = std::log10(most) + margin;
  const int first = static_cast<int>(std::ceil(axis.low)), last = static_cast<int>(std::floor(axis.high));
  const int step = static_cast<int>(std::ceil((last - first + 1) / kMostLogarithmicTicks));
  for (int e = first; e <= last; e += step) axis.ticks.push_back({(e - axis.low) / (axis.high - axis.low), decadeText(e)});
  return axis;
}

}  // namespace

double SweepAxis::place(double value) const {
  if (!std::isfinite(value) || ticks.empty() || (isLogarithmic && value <= 0.0)) return NAN;
  return ((isLogarithmic ? std::log10(value) : value) - low) / (high - low);
}

SweepAxis plainAxis(double low, double high) {
  SweepAxis axis;
  axis.low = low, axis.high = high;
  const Ticks round = chooseTicks(low, high);
  axis.power = powerText(round.power);
  for (std::size_t i = 0; i < round.values.size(); ++i) axis.ticks.push_back({(round.values[i] - low) / (high - low), round.labels[i]});
  return axis;
}

SweepAxis axisHolding(const std::vector<double>& values) {
  std::vector<double> rising;
  for (double v : values)
    if (std::isfinite(v)) rising.push_back(v);
  if (rising.empty()) return {};
  std::sort(rising.begin(), rising.end());
  const double least = rising.front(), most = rising.back();
  if (crowdsAtTheLowEnd(rising)) return logarithmicAxis(least, most);
  // Values that are one but for rounding are drawn as one.
  constexpr double kLeastSpan = 1e-6;
  const double size = std::max(std::abs(least), std::abs(most)), span = most - least;
  const double margin = span > kLeastSpan * size ? kAxisMargin * span : size > 0.0 ? 0.05 * size : 1.0;
  if (!std::isfinite(span + 2.0 * margin) || !std::isfinite(most + margin) || !std::isfinite(least - margin) || least - margin >= most + margin) return {};
  return plainAxis(least - margin, most + margin);
}

SweepAxis axisOfWords(const SweepFactor& choice, std::size_t characters) {
  SweepAxis axis;
  const std::size_t count = choice.choices.size();
  axis.low = -0.5, axis.high = static_cast<double>(count) - 0.5;
  for (std::size_t i = 0; i < count; ++i)
    axis.ticks.push_back(
        {(static_cast<double>(i) + 0.5) / static_cast<double>(count), shortenedText(choice.choices[i], std::max<std::size_t>(characters / count, 2))});
  return axis;
}

}  // namespace pitviper
