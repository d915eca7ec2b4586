#include "scenarios/sweep/student.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

double studentQuantile(double p, double degrees) {
  static const std::vector<QuadratureNode> unit = gaussLegendre(32, 0.0, 1.0);
  const double density = std::exp(std::lgamma(0.5 * (degrees + 1.0)) - std::lgamma(0.5 * degrees)) / std::sqrt(kPi), wanted = p - 0.5;
  // Share between 0 and an angle.
  const auto share = [&](double angle) {
    double sum = 0.0;
    for (const QuadratureNode& n : unit) sum += n.weight * std::pow(std::cos(angle * n.x), degrees - 1.0);
    return density * angle * sum;
  };
  // The share rises ever more slowly: Newton's steps from the left never go too far.
  double angle = 0.0;
  for (int step = 0; step < 100; ++step) {
    const double lacks = wanted - share(angle);
    if (!(lacks > 1e-14)) break;
    angle += lacks / (density * std::pow(std::cos(angle), degrees - 1.0));
  }
  return std::sqrt(degrees) * std::tan(angle);
}

}  // namespace pitviper
