#include "sensors/acquisition.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Of one direction [cycles/rad]: the midpoint rule over u = sqrt(f), in which an integrand that goes with 1 / sqrt(f) is even.
double integral(const Resolving& c, Bars bars, double difference_K) {
  constexpr int kSteps = 600;
  const double most = std::sqrt(nyquist_per_rad(c, bars));
  const Mrtd mrtd(c, bars);
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double u = most * (k + 0.5) / kSteps, over = 0.25 * kPi * difference_K / mrtd(u * u);
    if (over > 1.0) sum += 2.0 * u * std::sqrt(over) * most / kSteps;
  }
  return sum;
}

}  // namespace

const std::array<double, 3>& neededFor(Criterion criterion) {
  static const std::array<double, 3> johnson{1.0, 3.0, 6.0}, ttp{2.0, 7.5, 13.0};
  return criterion == Criterion::Johnson ? johnson : ttp;
}

double seenOf(const Resolving& c, const AcquiredTarget& t, Criterion criterion, double range_m, double transmittance) {
  const double size_rad = std::sqrt(t.area_m2()) / range_m, difference_K = t.difference_K * transmittance;
  if (criterion == Criterion::Johnson) return resolved_per_rad(c, difference_K) * size_rad;
  return std::sqrt(integral(c, Bars::SideBySide, difference_K) * integral(c, Bars::Stacked, difference_K)) * size_rad;
}

double probabilityOf(Criterion criterion, double seen, double needed) {
  const double ratio = seen / needed, power = std::pow(ratio, criterion == Criterion::Johnson ? 2.7 + 0.7 * ratio : 1.51 + 0.24 * ratio);
  return std::isfinite(power) ? power / (1.0 + power) : 1.0;
}

double rangeOf(const Resolving& c, const AcquiredTarget& t, Criterion criterion, double needed, const Transmittance& air) {
  double low = 0.0, high = std::log(1e6);  // of the range in metres
  const auto seen = [&](double logRange) { return seenOf(c, t, criterion, std::exp(logRange), air(std::exp(logRange))); };
  if (seen(low) < needed) return 0.0;
  if (seen(high) >= needed) return INFINITY;
  constexpr int kHalvings = 40;  // of 14 in the logarithm: 1e-11
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (seen(middle) >= needed ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace pitviper
