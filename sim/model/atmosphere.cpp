#include "sim/model/atmosphere.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {

AirAmounts Atmosphere::densities(double) const { return {}; }

std::vector<AirStation> Atmosphere::stations(const AirRay& ray, double range_m) const { return {{}, {range_m, 0.0, 0.0, amounts(ray, range_m)}}; }

std::vector<double> Atmosphere::placesAlong(const AirRay& ray, double range_m) const {
  std::vector<double> ranges;
  for (const AirStation& s : stations(ray, range_m)) ranges.push_back(s.range_m);
  return ranges;
}

std::vector<AirStation> Atmosphere::stationsAt(const AirRay& ray, std::span<const double> ranges_m) const {
  std::vector<AirStation> stations;
  for (double r : ranges_m) stations.push_back({r, 0.0, 0.0, amounts(ray, r)});
  return stations;
}

AirAmounts Atmosphere::powered(const AirAmounts& amounts) const {
  AirAmounts u;
  const auto powers = exponents();
  for (size_t k = 0; k < powers.size(); ++k) {
    const double w = std::max(amounts.amount[k], 0.0);
    u.amount[k] = powers[k] == 1.0 ? w : std::pow(w, powers[k]);
  }
  return u;
}

double Atmosphere::depthOf(const AirNode& node, const AirAmounts& powered) {
  double depth = 0.0;
  for (size_t k = 0; k < node.extinction.size(); ++k) depth += node.extinction[k] * powered.amount[k];
  return depth;
}

double Atmosphere::transmittance(const AirNode& node, const AirAmounts& amounts) const { return std::exp(-opticalDepth(node, amounts)); }

// B linear in optical depth t over a stretch of depth d seen through depth t0:
//   integral of B exp(-t0 - t) dt = exp(-t0) (B_near (1 - exp(-d)) + (B_far - B_near) g(d)),  g = (1 - exp(-d) (1 + d)) / d.
// This keeps the right limit on either side: B_near when opaque, the mean when thin.
void AirLight::emitted(std::span<const double> source, std::span<double> radiance) const {
  double sum = 0.0, seen = 1.0;
  if (!depth.empty()) seen = std::exp(-depth[0]), radiance[0] = 0.0;
  for (size_t i = 1; i < depth.size(); ++i) {
    const double d = std::max(depth[i] - depth[i - 1], 0.0), left = std::exp(-d), lost = physics::oneMinusExp(d);
    // The series where the difference would lose its digits: d/2 - d^2/3, next term d^3/8 below 2e-10 of it.
    const double g = d < 1e-3 ? d * (0.5 - d / 3.0) : (lost - d * left) / d;
    sum += seen * (source[i - 1] * lost + (source[i] - source[i - 1]) * g);
    seen *= left;
    radiance[i] = sum;
  }
}

void AirLight::reaching(std::span<const double> both, std::span<const double> lit, std::span<double> share) {
  if (!both.empty()) share[0] = 0.0;
  for (size_t i = 1; i < both.size(); ++i) {
    const double sun = 0.5 * (lit[i - 1] + lit[i]);
    share[i] = 0.0;
    if (!(sun > 0.0)) continue;
    const double near = lit[i - 1] > 0.0 ? both[i - 1] : both[i], far = lit[i] > 0.0 ? both[i] : both[i - 1];
    // The lesser depth comes out of the mean, so that neither overflows: looking up from shade, the way to the sun gets shorter by thousands.
    const double x = std::abs(far - near);
    const double mean = x < 1e-8 ? 1.0 - 0.5 * x : -std::expm1(-x) / x;
    share[i] = sun * std::exp(-std::min(near, far)) * mean;
  }
}

double rayleighPhase(double cosScatter) { return 3.0 / (16.0 * kPi) * (1.0 + cosScatter * cosScatter); }

double henyeyGreensteinPhase(double cosScatter, double asymmetry) {
  const double g = asymmetry, chord = 1.0 + g * g - 2.0 * g * cosScatter;
  return (1.0 - g * g) / (4.0 * kPi * chord * std::sqrt(chord));
}

}  // namespace pitviper
