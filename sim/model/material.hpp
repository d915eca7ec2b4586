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

/// Emissivity over wavelength and view angle: values[angle * wavelengths + w] at rising wavelengths [um] and equally spaced angles, linear
/// between, held beyond the last angle; without wavelengths there is no table.
struct EmissivityTable {
  std::vector<double> wavelength_um;
  AngleAxis view;
  std::vector<double> values;
};

/// Emissivity given by the user: eps(lambda) x angular factor over view angle, or a table over both.
struct GivenEmissivity {
  Spectrum emissivity;
  std::vector<double> viewAngle_rad;  ///< rising from 0, or empty: no dependence
  std::vector<double> factor;
  EmissivityTable table;  ///< instead of the three above, where it has wavelengths
  int modifier = -1;
  /// Throws OutsideSpectrum where the table or the spectrum has no data.
  double at(double wavelength_um, double viewAngle_rad) const;
  bool tabulated() const { return !table.wavelength_um.empty(); }
  bool varies() const { return tabulated() || !viewAngle_rad.empty(); }  ///< with view angle
  /// Where it bends, rising.
  std::vector<double> knots_um() const { return tabulated() ? table.wavelength_um : emissivity.knots(); }
  std::vector<double> knots_rad() const;
  double validLow_um() const { return tabulated() ? table.wavelength_um.front() : emissivity.validLow(); }
  double validHigh_um() const { return tabulated() ? table.wavelength_um.back() : emissivity.validHigh(); }
};

struct Material {
  std::string name;
  std::string provenance;
  Location where;
  std::vector<std::shared_ptr<const ReflectionComponent>> reflections;  ///< at most three
  std::vector<int> modifiers;                                           ///< texture index or -1, one per reflection
  std::optional<GivenEmissivity> given;                                 ///< absent: Kirchhoff, 1 - reflectance

  /// Sum of the components' directional-hemispherical reflectances, modifiers at 1.
  double reflectance(double wavelength_um, double viewAngle_rad) const;
  double emissivity(double wavelength_um, double viewAngle_rad) const;
  /// View angles at which an emissivity or a table over the view angle bends, rising, below 90 deg.
  std::vector<double> viewKnots_rad() const;
  bool hemisphericalVaries() const;  ///< reflectance or given emissivity with view angle
  bool needsAngles() const;          ///< a table over angles, or an emissivity that changes with view
  bool hasModifiers() const;
  double validLow_um() const;
  double validHigh_um() const;
};

}  // namespace pitviper
