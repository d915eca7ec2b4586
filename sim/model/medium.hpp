#pragma once
// The contract of what fills a body without hiding what is behind: an absorbing and emitting gas or smoke, which may scatter sunlight.
#include <algorithm>
#include <optional>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Optical depth = absorption x length of path inside the body (of a field: x amount, see sim/model/field.hpp). It emits as a black body of its temperature
/// (Kirchhoff, for the part that is not scattered), and sends `radiance` besides: what it would show at great depth without emission.
/// Where it has an albedo, that part of its extinction scatters: sunlight once, with the phase function of Henyey and Greenstein, and ambient light as if it
/// came evenly from all around.
struct Medium {
  Spectrum absorption_per_m;         ///< extinction where there is an albedo
  std::optional<Spectrum> radiance{};  ///< [W/(m2 sr um)]
  std::optional<Spectrum> albedo{}, asymmetry{};  ///< single-scattering; mean cosine of scattering
  double validLow_um() const {
    double low = absorption_per_m.validLow();
    for (const auto* s : {&radiance, &albedo, &asymmetry})
      if (*s) low = std::max(low, (*s)->validLow());
    return low;
  }
  double validHigh_um() const {
    double high = absorption_per_m.validHigh();
    for (const auto* s : {&radiance, &albedo, &asymmetry})
      if (*s) high = std::min(high, (*s)->validHigh());
    return high;
  }
  double albedoAt(double wavelength_um) const { return albedo ? (*albedo)(wavelength_um) : 0.0; }
  /// Source radiance at a temperature [W/(m2 sr um)], of its own; `gain`: factor of `radiance`.
  double source(double wavelength_um, double temperature_K, double gain = 1.0) const;
  /// What it turns of sunlight, per irradiance of 1 and extinction: albedo x phase function [1/sr].
  double scattered(double wavelength_um, double cosScatter) const;
};

}  // namespace pitviper
