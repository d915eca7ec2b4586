#pragma once
// A material: up to three reflection components and what it emits.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/component.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Emissivity given by the user: eps(lambda) x angular factor over view angle.
struct GivenEmissivity {
  Spectrum emissivity;
  std::vector<double> viewAngle_rad;  ///< rising from 0, or empty: no dependence
  std::vector<double> factor;
  int modifier = -1;
  double at(double wavelength_um, double viewAngle_rad) const;
};

struct Material {
  std::string name;
  std::string provenance;
  Location where;
  std::vector<std::shared_ptr<const ReflectionComponent>> reflections;  ///< at most three
  std::vector<int> modifiers;                                          ///< texture index or -1, one per reflection
  std::optional<GivenEmissivity> given;                                ///< absent: Kirchhoff, 1 - reflectance

  /// Sum of the components' directional-hemispherical reflectances, modifiers at 1.
  double reflectance(double wavelength_um, double viewAngle_rad) const;
  double emissivity(double wavelength_um, double viewAngle_rad) const;
  bool needsAngles() const;     ///< a table over angles, or an emissivity that changes with view
  bool hasModifiers() const;
  double validLow_um() const;
  double validHigh_um() const;
};

}  // namespace pitviper
