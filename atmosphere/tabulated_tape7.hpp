#pragma once
// Air by tables from MODTRAN's runs.
#include <optional>
#include <span>

#include "atmosphere/tabulated_air.hpp"
#include "atmosphere/tape7.hpp"

namespace pitviper {

/// Which of a file's paths is meant, where it has several; the range of the only one, where the file does not say it.
struct PathChoice {
  std::optional<double> range_m = {};
  std::optional<double> height_m = {};       ///< of the observer (H1)
  std::optional<double> elevation_rad = {};  ///< 0: the level ones
};

/// Air along the horizontal or slant paths of a file's runs (ITYPE 1, 2; IEMSCT 0, 1, 2), all of one height and direction, over one grid of wavenumbers.
/// Of a file that has both, and unless an elevation is asked for, the level runs: never slant ones beside them. Runs left out are in the description.
/// - Several ranges: non-negative fit of the powers 0.55, 0.75 and 1 at each wavenumber.
/// - One range, a transmittance run: each component's own power, water lines 0.552, mixed gases and trace gases 0.605, ozone 0.767, all else 1
///   (as in the library's .air files, from LOWTRAN 7's 20 1/cm bands; finer bands bend less), made to give the run's total.
/// - One range, a radiance run: one exponential. It is wrong at other ranges as homogeneous air is: by up to 0.1 in the 3-5 um mean.
/// Radiance runs give J; without one the air sends nothing. With the sun in a run (IEMSCT 2) its geometry is in J.
/// Radiance runs to space (ITYPE 3) in the file give the sky by elevation.
/// Errors: UserError with the line of the run at fault, also where paths of several heights or directions are left.
TabulatedAir tabulatedAir(std::span<const Tape7Run> runs, const PathChoice& choice = {});

/// The sky of a file's radiance runs to space; none if it holds no such run. Errors: UserError for an unknown zenith angle, one that comes twice or
/// looks down, observers at different heights, different wavenumbers.
std::optional<TabulatedSky> tabulatedSky(std::span<const Tape7Run> runs);

}  // namespace pitviper
