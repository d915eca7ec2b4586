#include "tests/support/air_radiance.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper::test {
namespace {

double depthOf(const std::array<double, kMostAirAmounts>& coefficients, const AirAmounts& powered) {
  double sum = 0.0;
  for (size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * powered.amount[k];
  return sum;
}

/// Mean of t exp(-t d) over 0 to 1, times d; by its series where the difference would lose its digits.
double growth(double d) {
  if (d > 0.1) return (-std::expm1(-d) - d * std::exp(-d)) / d;
  double sum = 0.0, term = d;
  for (int n = 0; n < 12; ++n) sum += term / (n + 2.0), term *= -d / (n + 1.0);
  return sum;
}

}  // namespace

// Sources and the sun's share of its disc go evenly from station to station.
AirRadiance airRadiance(const AirNode& node, const SunlitAir& air, std::span<const double> source) {
  const size_t stations = air.stations.size();
  const std::vector<double> none(air.lit.empty() ? 0 : stations, 0.0);
  AirRadiance out{std::vector<double>(stations), std::vector<double>(stations), none, none};
  for (size_t s = 0; s < stations; ++s) {
    const AirAmounts& here = air.powered[s];
    out.depth[s] = depthOf(node.extinction, here);
    if (s == 0) continue;
    const double d = std::max(out.depth[s] - out.depth[s - 1], 0.0), near = node.source + source[s - 1], far = node.source + source[s];
    out.thermal[s] = out.thermal[s - 1] + std::exp(-out.depth[s - 1]) * (near * -std::expm1(-d) + (far - near) * growth(d));
    if (air.lit.empty()) continue;
    out.molecules[s] = out.molecules[s - 1], out.haze[s] = out.haze[s - 1];
    const double sun = 0.5 * (air.lit[s - 1] + air.lit[s]);
    if (!(sun > 0.0)) continue;
    const double before = depthOf(node.extinction, air.both[air.lit[s - 1] > 0.0 ? s - 1 : s]),
                 after = depthOf(node.extinction, air.both[air.lit[s] > 0.0 ? s : s - 1]);
    const double change = std::abs(after - before), reaching = sun * std::exp(-std::min(before, after)) * (change > 0.0 ? -std::expm1(-change) / change : 1.0);
    const AirAmounts& last = air.powered[s - 1];
    out.molecules[s] += std::max(depthOf(node.molecules, here) - depthOf(node.molecules, last), 0.0) * reaching;
    out.haze[s] += std::max(depthOf(node.haze, here) - depthOf(node.haze, last), 0.0) * reaching;
  }
  return out;
}

}  // namespace pitviper::test
