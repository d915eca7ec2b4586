#pragma once
// Air so thick that people call it fog, which is haze here: what it lets through in the infrared that fog would not.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// An air whose haze scales with the visibility.
class HasHaze {
 public:
  virtual ~HasHaze() = default;
  /// Extinction of the haze at height 0 [1/km], and the part of it that it absorbs.
  virtual double hazePer_km(double wavelength_um) const = 0;
  virtual double hazeAbsorbs(double wavelength_um) const = 0;
};

/// One sentence where the visibility is below 1 km, by definition fog's, and the haze weakens 10 um less than fogs do; else empty.
/// Fogs: extinction at 10 um over that at 0.55 um, 0.24139 of radiation fog, 1.22677 of advection fog. Source: Shettle and Fenn 1979, AFGL-TR-79-0214, as in
/// LOWTRAN 7 (Kneizys et al. 1988, AFGL-TR-88-0177; moderate radiation fog and heavy advection fog).
std::string hazeNotFog(const Simulation& simulation);

}  // namespace pitviper
