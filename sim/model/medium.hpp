#pragma once
// The contract of what fills a body without hiding what is behind: an absorbing and emitting gas or smoke.
#include <algorithm>
#include <optional>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Optical depth = absorption x length of path inside the body. It emits as a black body of its temperature (Kirchhoff), and sends
/// `radiance` besides: what it would show at great depth without emission, for instance scattered sunlight.
struct Medium {
  Spectrum absorption_per_m;
  std::optional<Spectrum> radiance;  ///< [W/(m2 sr um)]
  double validLow_um() const { return std::max(absorption_per_m.validLow(), radiance ? radiance->validLow() : kShortestWavelength_um); }
  double validHigh_um() const { return std::min(absorption_per_m.validHigh(), radiance ? radiance->validHigh() : kLongestWavelength_um); }
  /// Source radiance at a temperature [W/(m2 sr um)].
  double source(double wavelength_um, double temperature_K) const;
};

}  // namespace pitviper
