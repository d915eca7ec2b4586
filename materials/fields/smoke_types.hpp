#pragma once
// Smokes by name: what a kilogram of their particles does with light.
#include <span>
#include <string_view>

#include "sim/model/medium.hpp"

namespace pitviper {

struct SmokeOptics {
  double wavelength_um = 0.0;
  double extinction_m2_kg = 0.0, albedo = 0.0, asymmetry = 0.0;
};

struct SmokeType {
  std::string_view name, description, source;
  std::span<const SmokeOptics> optics;  ///< rising; 0.3 to 30 um; extinction linear in its logarithms, the others in wavelength
};

std::span<const SmokeType> smokeTypes();
/// Null where there is none of that name.
const SmokeType* findSmokeType(std::string_view name);
/// Extinction, albedo and asymmetry over 0.3 to 30 um; an amount of it is mass per area [kg/m2].
Medium smokeGas(const SmokeType& type);

}  // namespace pitviper
