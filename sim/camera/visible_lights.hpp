#pragma once
// A point light in view adds its own flux, I tau A_ap cos(psi) / R^2, to the subpixel it falls into, unless something stands in
// front of it on the very line to it.
#include "sim/camera/subpixels.hpp"
#include "sim/radiance/node_sum.hpp"

namespace pitviper {

/// Whether a light is on the film, in front of the camera, in a subpixel that is wanted. Something may stand before it.
bool lightIsInView(const Simulation& simulation, const WorldState& state, const View& view, size_t light);

/// Ways from an eye to lights, by the radiance equation in double precision: nothing is drawn for them.
class WaysToLights {
 public:
  /// Both must outlive it.
  WaysToLights(const Simulation& simulation, const Plan& plan);
  /// What of a light or of the sun reaches a place from a direction (unit): a factor per node, the transmittance of everything transparent on
  /// the way (air not counted); empty where something solid stands there. `present`: one flag per entity.
  std::vector<double> from(const WorldState& state, const std::vector<char>& present, const glm::dvec3& place, const glm::dvec3& direction, double distance_m,
                           double near_m) const;

 private:
  const Simulation& simulation_;
  Terms terms_;  ///< without air
  const Plan& plan_;
  mutable std::unique_ptr<const NodeSpectra> spectra_;  ///< once something transparent stands before a light
};

void addVisibleLights(Subpixels& image, const WaysToLights& ways, const Simulation& simulation, const Plan& plan, const WorldState& state,
                      const std::vector<char>& present);

/// Integral of kernel x I x tau over a slot's nodes [kernel unit x W/sr] for a light seen from a place, through `way`.
std::vector<double> apparentIntensity(const Simulation& simulation, const Plan& plan, const WorldState& state, size_t light, const glm::dvec3& from,
                                      const std::vector<double>& way);

}  // namespace pitviper
