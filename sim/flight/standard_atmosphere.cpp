#include "sim/flight/standard_atmosphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pitviper {
namespace {

constexpr double kGasConstant = 8314.32, kMolarMass = 28.9644;  // J/(kmol K), kg/kmol: table 2
constexpr double kGravity = 9.80665, kEarthRadius_m = 6356766.0;
constexpr double kHeatRatio = 1.4, kSutherland = 1.458e-6, kSutherland_K = 110.4;
constexpr double kHydrostatic = kGravity * kMolarMass / kGasConstant;  // K/m

struct Layer {
  double base_m, lapse_K_m;
};
constexpr std::array<Layer, 8> kLayers{{{0.0, -6.5e-3},
                                        {11000.0, 0.0},
                                        {20000.0, 1.0e-3},
                                        {32000.0, 2.8e-3},
                                        {47000.0, 0.0},
                                        {51000.0, -2.8e-3},
                                        {71000.0, -2.0e-3},
                                        {84852.0, 0.0}}};  // the last is ours: above 86 km

struct Base {
  double temperature_K, pressure_Pa;
};

Base across(const Layer& layer, const Base& base, double above_m) {
  const double t = base.temperature_K + layer.lapse_K_m * above_m;
  const double exponent =
      layer.lapse_K_m == 0.0 ? -kHydrostatic * above_m / base.temperature_K : kHydrostatic / layer.lapse_K_m * std::log(base.temperature_K / t);
  return {t, base.pressure_Pa * std::exp(exponent)};
}

std::array<Base, kLayers.size()> makeBases() {
  std::array<Base, kLayers.size()> bases{};
  bases[0] = {288.15, 101325.0};
  for (std::size_t i = 1; i < bases.size(); ++i) bases[i] = across(kLayers[i - 1], bases[i - 1], kLayers[i].base_m - kLayers[i - 1].base_m);
  return bases;
}

}  // namespace

double geopotentialHeight_m(double height_m) { return kEarthRadius_m * height_m / (kEarthRadius_m + height_m); }

StandardAir standardAir(double height_m) {
  static const std::array<Base, kLayers.size()> bases = makeBases();
  const double h = geopotentialHeight_m(std::max(height_m, -5000.0));
  std::size_t i = 0;
  while (i + 1 < kLayers.size() && h >= kLayers[i + 1].base_m) ++i;
  const Base at = across(kLayers[i], bases[i], h - kLayers[i].base_m);
  StandardAir air;
  air.temperature_K = at.temperature_K;
  air.pressure_Pa = at.pressure_Pa;
  air.density_kg_m3 = at.pressure_Pa * kMolarMass / (kGasConstant * at.temperature_K);
  air.soundSpeed_m_s = std::sqrt(kHeatRatio * kGasConstant / kMolarMass * at.temperature_K);
  air.viscosity_Pa_s = kSutherland * at.temperature_K * std::sqrt(at.temperature_K) / (at.temperature_K + kSutherland_K);
  return air;
}

}  // namespace pitviper
