#pragma once
// What a material's surface reflects, emits and lets through, for those who ask in arrays: by the models themselves, as the reference has them.
//
// Angles are between a direction and the normal, 0 to pi/2 [rad]; directions are unit vectors from the surface, in axes whose z is its normal. Textures count
// as 1. Results are [.. x wavelengths + wavelength]. Every function throws UserError, at its own name, for wavelengths at which the material has no data,
// angles and directions beyond the hemisphere, and entries that are not finite. Source: sim/model/material.hpp, materials/README.md.
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// One of a scenario's materials; UserError with the names there are.
std::shared_ptr<const Material> materialOf(const Simulation& simulation, const std::string& name);

/// Without a scenario, as `pitviper material` takes it: a material of the library, a file of one, or a substance as facets of roughness 0.05. UserError for
/// what is none of these.
std::shared_ptr<const Material> materialOf(const std::string& name, const Libraries& libraries);

/// The unit vector at an angle to the normal and an azimuth about it.
glm::dvec3 directionAt(double angle_rad, double azimuth_rad = 0.0);

class SurfacePhysics {
 public:
  /// `state`: of a material that has states (states()); none: the first of them. UserError for a medium, which has no surface, and for a state that the
  /// material has not or does not reach.
  explicit SurfacePhysics(std::shared_ptr<const Material> material, std::optional<double> state = {});

  /// What a material changes with.
  struct States {
    bool isTemperature = false;  ///< [K]; else what a texture drives, in the unit of its model: wetness, thickness of a film [um]
    double low = 0.0, high = 0.0;
  };
  std::optional<States> states() const;
  const Material& material() const { return *material_; }
  double low_um() const { return material_->validLow_um(); }
  double high_um() const { return material_->validHigh_um(); }

  /// BRDF [1/sr] of light that comes from a direction, for each view.
  std::vector<double> brdf(std::span<const double> wavelength_um, const glm::dvec3& light, std::span<const glm::dvec3> views) const;
  /// Share of a beam that comes back into the hemisphere, by the angle of the beam; by reciprocity also that of an even sky's light that is seen from there.
  std::vector<double> reflectance(std::span<const double> wavelength_um, std::span<const double> angle_rad) const;
  /// Given, or what is neither reflected nor let through (Kirchhoff).
  std::vector<double> emissivity(std::span<const double> wavelength_um, std::span<const double> angle_rad) const;
  /// Of the whole layer that the surface stands for; 0 of an opaque one.
  std::vector<double> transmittance(std::span<const double> wavelength_um, std::span<const double> angle_rad) const;

 private:
  /// Materials between which its state lies, with their shares: one, or two neighbours.
  std::vector<std::pair<const Material*, double>> mix_;
  std::shared_ptr<const Material> material_;

  void requireData(const char* function, std::span<const double> wavelength_um) const;
  template <class OfMaterial>
  std::vector<double> byAngle(const char* function, std::span<const double> wavelength_um, std::span<const double> angle_rad, OfMaterial&& value) const;
};

}  // namespace pitviper
