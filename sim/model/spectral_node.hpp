#pragma once
// What a plan evaluates as if it were one wavelength: a wavelength, or several that the air treats alike, averaged.
#include <vector>

#include "sim/model/atmosphere.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {

struct SpectralNode {
  struct Member {
    double wavelength_um = 0.0;
    double share = 1.0;
  };
  std::vector<Member> members;  ///< shares sum to 1: emissivity + reflectance + transmittance stays 1
  AirNode air;
  std::vector<double> absorption_per_m;  ///< of each material's medium, 0 for a surface

  bool isWavelength() const { return members.size() == 1; }
  /// Weighted mean of a function of wavelength.
  template <class F>
  auto mean(const F& f) const -> decltype(f(0.0)) {
    auto sum = members.front().share * f(members.front().wavelength_um);
    for (size_t k = 1; k < members.size(); ++k) sum += members[k].share * f(members[k].wavelength_um);
    return sum;
  }
  double planck(double temperature_K) const {
    return mean([temperature_K](double w) { return physics::planckRadiance(w, temperature_K); });
  }
};

}  // namespace pitviper
