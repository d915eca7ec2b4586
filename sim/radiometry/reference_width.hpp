#pragma once
// How far apart the wavelengths of the reference lie: what is finer is a mean over it.
#include <algorithm>

namespace pitviper {

/// 5 1/cm or 1 nm, whichever is wider; of the far infrared, where 5 1/cm are a half of the wavelength, no more than a hundredth of it: with
/// x = c2 / (lambda T) the middle of a bin is off Planck's mean by up to x^2 / 24 x 0.01^2: 1e-4 at x = 5, where most of its light is, and of either sign.
inline double referenceWidth_um(double wavelength_um) {
  constexpr double kWidth_per_cm = 5.0, kWidth_um = 1e-3, kPart = 0.01;
  return std::min(std::max(kWidth_um, kWidth_per_cm * 1e-4 * wavelength_um * wavelength_um), std::max(kPart * wavelength_um, kWidth_um));
}

}  // namespace pitviper
