#include "sim/model/path.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {

AirAmounts Path::powered(const AirAmounts& amounts) const {
  AirAmounts u;
  const auto powers = exponents();
  for (size_t k = 0; k < powers.size(); ++k) {
    const double w = std::max(amounts.amount[k], 0.0);
    u.amount[k] = powers[k] == 1.0 ? w : std::pow(w, powers[k]);
  }
  return u;
}

double Path::depthOf(const AirNode& node, const AirAmounts& powered) {
  double depth = 0.0;
  for (size_t k = 0; k < node.extinction.size(); ++k) depth += node.extinction[k] * powered.amount[k];
  return depth;
}

double Path::transmittance(const AirNode& node, const AirAmounts& amounts) const { return std::exp(-opticalDepth(node, amounts)); }

// J linear in optical depth t over a stretch of depth d seen through depth t0:
//   integral of J exp(-t0 - t) dt = exp(-t0) (J_near (1 - exp(-d)) + (J_far - J_near) g(d)),  g = (1 - exp(-d) (1 + d)) / d.
// This keeps the right limit on either side: J_near when opaque, the mean when thin.
void emittedAlong(std::span<const double> depth, std::span<const double> source, std::span<double> radiance) {
  double sum = 0.0, seen = 1.0;
  if (!depth.empty()) seen = std::exp(-depth[0]), radiance[0] = 0.0;
  for (size_t i = 1; i < depth.size(); ++i) {
    const double d = std::max(depth[i] - depth[i - 1], 0.0), left = std::exp(-d), emitted = physics::oneMinusExp(d);
    // The series where the difference would lose its digits: d/2 - d^2/3, next term d^3/8 below 2e-10 of it.
    const double g = d < 1e-3 ? d * (0.5 - d / 3.0) : (emitted - d * left) / d;
    sum += seen * (source[i - 1] * emitted + (source[i] - source[i - 1]) * g);
    seen *= left;
    radiance[i] = sum;
  }
}

}  // namespace pitviper
