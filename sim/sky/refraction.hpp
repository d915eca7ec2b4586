#pragma once
// Apparent elevations of what stands in the sky, where the air's structure is not known.

namespace pitviper {

/// By how much air lifts what stands at a true elevation, as seen from the ground [rad].
/// Law: R = 1.02' cot(e + 10.3 / (e + 5.11)) P / 1010 hPa 283 K / T, e true elevation in degrees; below a true elevation of -0.575 degrees, which is seen on
/// the
///   horizon, held.
/// Source: Saemundsson 1986, Sky and Telescope 72, 70, the inverse of Bennett 1982, J. Navigation 35, 255, to 0.1'; scale: Meeus 1998, chapter 16.
/// Valid: visible light (1.6 % less from 2 um on). Errors: 0.07' above 15 degrees, on the horizon as the lowest air is layered, some minutes on single days.
double refraction_rad(double trueElevation_rad, double pressure_Pa, double temperature_K);

}  // namespace pitviper
