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

void AirLight::emitted(std::span<const double> source, std::span<double> radiance) const {
  double sum = 0.0, seen = 1.0;
  if (!depth.empty()) seen = std::exp(-depth[0]), radiance[0] = 0.0;
  for (size_t i = 1; i < depth.size(); ++i) {
    const double d = std::max(depth[i] - depth[i - 1], 0.0), left = std::exp(-d);
    sum += seen * physics::segmentRadiance(source[i - 1], source[i], d, left, physics::lostOf(d, left));
    seen *= left;
    radiance[i] = sum;
  }
}

}  // namespace pitviper
