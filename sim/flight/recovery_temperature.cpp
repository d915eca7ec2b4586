#include "sim/flight/recovery_temperature.hpp"

#include <cmath>

#include "sim/flight/standard_atmosphere.hpp"

namespace pitviper {
namespace {
constexpr double kPrandtl = 0.71, kHeatRatio = 1.4;
}

double recoveryFactor(BoundaryLayer layer) { return layer == BoundaryLayer::Laminar ? std::sqrt(kPrandtl) : std::cbrt(kPrandtl); }

double recoveryTemperature_K(double airTemperature_K, double mach, BoundaryLayer layer) {
  return airTemperature_K * (1.0 + recoveryFactor(layer) * 0.5 * (kHeatRatio - 1.0) * mach * mach);
}

double recoveryTemperatureAt_K(double height_m, double airSpeed_m_s, BoundaryLayer layer) {
  const StandardAir air = standardAir(height_m);
  return recoveryTemperature_K(air.temperature_K, airSpeed_m_s / air.soundSpeed_m_s, layer);
}

}  // namespace pitviper
