#include "materials/phong_albedo.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

double PhongAlbedo::at(double theta) const {
  const double st = std::sin(theta), ct = std::cos(theta);
  if (st <= 0.0) return 1.0;
  // c = sin(theta) exp(-y^2 / (n + 1)): the power becomes a Gaussian, and where the horizon begins to cut, the rings are smooth in y.
  static const auto rule = gaussLegendre(32, 0.0, 5.5);
  double sum = 0.0;
  for (const auto& node : rule) {
    const double y = node.x, s = std::exp(-y * y / (n_ + 1.0)), c = st * s;
    const double phi = std::acos(std::clamp(-c * ct / (st * std::sqrt((1.0 - c) * (1.0 + c))), -1.0, 1.0));
    const double ring = phi * c * ct + st * std::sqrt(std::max(0.0, -std::expm1(-2.0 * y * y / (n_ + 1.0))));
    sum += node.weight * std::exp(-y * y) * 2.0 * y / (n_ + 1.0) * ring;
  }
  return std::min(1.0, ct * (1.0 - std::pow(st, n_ + 2.0)) + (n_ + 2.0) / kPi * std::pow(st, n_ + 1.0) * sum);
}

}  // namespace pitviper
