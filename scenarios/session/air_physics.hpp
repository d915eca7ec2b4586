#pragma once
// The air of a scenario between two places and towards the sky, for those who ask in arrays: by the reference, in double precision.
//
// What a value at a wavelength means: the air's own law is asked there, which knows nothing finer than what it was made from.
//   Library air and .air tables: LOWTRAN's band models. A transmittance is a mean over 20 1/cm, given at every 5 1/cm and linear between (0.2 um at 10 um, 5 nm
//     at 1.6 um); `pitviper atmosphere` prints means of these over its bands, unweighted. It is no transmittance of a laser's line.
//   Air from a table (MODTRAN's, LBLRTM's, measured): what the table has at its own wavelengths, as wide as its maker's slit; linear between.
//   Air of a constant extinction: at the wavelength itself.
// The transmittance of a band is not that of its middle, and does not multiply along a path: sum over wavelengths for each path (bandTransmittance()), in steps
//   of 5 1/cm or 1 nm, whichever is wider (referenceWidth_um()), or finer.
// Path radiance and sky have thermal emission of the air, sunlight it scatters once, and light scattered any number of times (16 streams). Bodies, smoke,
// fields
//   and lamps are left out: they are pictures' business. Clouds and fog that the air itself has are in it.
// Places are in the scenario's local frame [m]. Errors: UserError where the earth stands between, and at wavelengths of which the air, the sun, the ground or
// the
//   background has no data.
// Source: sim/radiance/radiance.hpp.
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenarios/session/band_physics.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// What lies between two places, by wavelength.
struct AirPath {
  double range_m = 0.0;
  std::vector<double> opticalDepth;
  std::vector<double> transmittance;  ///< exp(-opticalDepth)
  std::vector<double> pathRadiance;   ///< what the air sends to the first place [W/(m2 sr um)]
};

/// Looking from one place to another. Without air, or where both are the same place: all is let through and nothing is sent.
AirPath pathThrough(const Simulation& simulation, const glm::dvec3& from, const glm::dvec3& to, std::span<const double> wavelength_um);

/// Radiance of the sky in a direction of any length, with the scenario's background behind it, without the sun's disc, stars and bodies [W/(m2 sr um)].
std::vector<double> skyRadiance(const Simulation& simulation, const glm::dvec3& from, const glm::dvec3& direction, std::span<const double> wavelength_um);

/// Of the light of a black body at the far end: what a detector gets through the air of what it would get without,
///   integral of S B(T) tau / integral of S B(T), over the reference's wavelengths (fineGrid()).
/// Where less than 0.5 % of the response lies beyond the air's data, that is left out, as of cameras.
double bandTransmittance(const Simulation& simulation, const glm::dvec3& from, const glm::dvec3& to, const Responsivity& band, double source_K);

}  // namespace pitviper
