#pragma once
// What shines on the drops of a field (Droplets), and their optics, at wavelengths and nodes.
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "sim/model/field.hpp"
#include "sim/model/simulation.hpp"
#include "sim/model/spectral_node.hpp"

namespace pitviper {

/// Radiance of sky and ground: the mean over all directions above and below, at the drops' height.
struct CloudLight {
  physics::CloudOptics optics{};
  double sun = 0.0;                 ///< irradiance [W/(m2 um)]
  double above = 0.0, below = 0.0;  ///< [W/(m2 sr um)]
};

/// Safe to ask from several threads.
class CloudLights {
 public:
  /// Of a field that has droplets(). Both must outlive it.
  CloudLights(const Simulation& simulation, const FieldBody& field);
  /// `around`: with sky and ground, else these are 0.
  CloudLight at(double wavelength_um, bool around = true) const;
  /// What at() needs of the surroundings; of many wavelengths that costs less than one by one.
  void prepare(std::vector<double> wavelengths_um) const;
  /// Each averaged by itself, as pictures have it.
  std::vector<CloudLight> of(std::span<const SpectralNode> nodes) const;

 private:
  glm::dvec2 around(double wavelength_um) const;
  const Simulation& simulation_;
  const Droplets& drops_;
  int material_;
  mutable std::mutex busy_;
  mutable std::map<double, glm::dvec2> around_;  ///< kept
  std::vector<glm::dvec2> shares_;               ///< of each direction of the surroundings, of what is above and below
};

}  // namespace pitviper
