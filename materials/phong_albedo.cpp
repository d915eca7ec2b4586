#include "materials/phong_albedo.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

PhongAlbedo::PhongAlbedo(double n) : factor_((n + 2.0) / (n + 1.0) / (2.0 * kPi)) {
  static const double edges[] = {0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0};
  for (const auto& node : fineNodes(0.0, 1.0, edges, 512)) {
    const double ca = std::pow(node.x, 1.0 / (n + 1.0));
    rings_.push_back({ca, std::sqrt(std::max(0.0, 1.0 - ca * ca)), node.weight});
  }
}

double PhongAlbedo::at(double theta) const {
  const double ct = std::cos(theta), st = std::sin(theta);
  double sum = 0.0;
  for (const Ring& r : rings_) {
    const double a = ct * r.cosine, b = st * r.sine;
    double ring = 2.0 * kPi * a;
    if (b > a) {
      const double phi = std::acos(std::clamp(-a / b, -1.0, 1.0));
      ring = 2.0 * (phi * a + b * std::sin(phi));
    }
    sum += r.weight * ring;
  }
  return factor_ * sum;
}

}  // namespace pitviper
