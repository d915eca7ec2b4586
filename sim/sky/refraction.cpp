#include "sim/sky/refraction.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

double refraction_rad(double trueElevation_rad, double pressure_Pa, double temperature_K) {
  constexpr double kDegree = kPi / 180.0, kOnHorizon_deg = -0.575;
  const double e = std::max(trueElevation_rad / kDegree, kOnHorizon_deg);
  const double minutes = 1.02 / std::tan((e + 10.3 / (e + 5.11)) * kDegree);
  return std::max(minutes, 0.0) / 60.0 * kDegree * (pressure_Pa / 101000.0) * (283.0 / temperature_K);
}

}  // namespace pitviper
