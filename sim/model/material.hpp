#pragma once
// A material: a surface (up to three reflection components, what it emits and what it lets through) or a medium that fills a body.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/component.hpp"
#include "sim/model/medium.hpp"
#include "sim/model/view_spectrum.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

struct Material {
  std::string name;
  std::string provenance;
  Location where;
  std::vector<std::shared_ptr<const ReflectionComponent>> reflections;  ///< at most three
  std::vector<int> modifiers;                                           ///< texture index or -1, one per reflection
  std::optional<ViewSpectrum> given;                                    ///< emissivity; absent: Kirchhoff, 1 - reflectance - transmittance
  std::optional<ViewSpectrum> transmission;                             ///< transmittance of the whole layer that the surface stands for; absent: opaque
  std::optional<Medium> medium;                                         ///< a medium has none of the above

  /// What lies behind it is seen through it.
  bool isTransparent() const { return transmission || medium; }
  /// Sum of the components' directional-hemispherical reflectances, modifiers at 1.
  double reflectance(double wavelength_um, double viewAngle_rad) const;
  double transmittance(double wavelength_um, double viewAngle_rad) const { return transmission ? transmission->at(wavelength_um, viewAngle_rad) : 0.0; }
  double emissivity(double wavelength_um, double viewAngle_rad) const;
  /// View angles at which an emissivity or a table over the view angle bends, rising, below 90 deg.
  std::vector<double> viewKnots_rad() const;
  bool hemisphericalVaries() const;  ///< reflectance, transmittance or given emissivity with view angle
  bool needsAngles() const;          ///< a table over angles, or an emissivity that changes with view
  bool hasModifiers() const;
  double validLow_um() const;
  double validHigh_um() const;
};

}  // namespace pitviper
