#pragma once
// A material: a surface (reflection components, what it emits and what it lets through) or a medium that fills a body.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/component.hpp"
#include "sim/model/medium.hpp"
#include "sim/model/view_spectrum.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

struct Material;

/// A state of a surface that a texture drives (wetness, thickness of a film), or its temperature: between two entries, which lie evenly over it, the surface is
/// linear.
struct MaterialStates {
  int texture = -1;                                      ///< -1: its temperature [K]
  double low = 0.0, high = 1.0;                          ///< of what drives it: states of the first and the last entry
  std::vector<std::shared_ptr<const Material>> entries;  ///< two or more, with the same axes, lobes and textures, without states of their own
};

struct Material {
  std::string name;
  std::string provenance;
  std::vector<std::string> notes;  ///< what was changed or left out of what the user gave
  Location where;
  std::vector<std::shared_ptr<const ReflectionComponent>> reflections;
  std::vector<int> modifiers;                ///< texture index or -1, one per reflection
  std::optional<ViewSpectrum> given;         ///< emissivity; absent: Kirchhoff, 1 - reflectance - transmittance
  std::optional<ViewSpectrum> transmission;  ///< transmittance of the whole layer that the surface stands for; absent: opaque
  std::optional<Medium> medium;              ///< a medium has none of the above
  std::optional<MaterialStates> states;      ///< where there are some, the above are those of the first entry

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
