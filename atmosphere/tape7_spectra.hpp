#pragma once
// Spectra of a tape7 run for the rest of pitviper. They have data only where the run has (Outside::Error).
#include <string>

#include "atmosphere/tape7.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// COMBIN_TRANS, TOT_TRANS or TRANS by the kind of run; what rounding put above 1 is 1.
Spectrum totalTransmittance(const Tape7Run& run);

/// What the air itself sends along the path [W/(m2 sr um)]: PTH_THRML + SOL_SCAT, the first with the thermal radiation it scatters
/// (THRML_SCT), the second with the single scattering (SING_SCAT). It is TOTAL_RAD less what comes from the surface through the air,
/// SURF_EMIS and GRND_RFLT, without the digits that the difference loses; the two are compared. A thermal run (IEMSCT 1) has no SOL_SCAT.
/// MODTRAN 6 writes THRML_EM + THRML_SCT + MULT_SCAT + SING_SCAT instead, each apart from the others (names as in the head of a tape7 of it,
/// https://github.com/jean-allen/modtran6-case-iteration, whose rows are not there).
/// Errors: UserError for runs of other kinds, columns that are blank, sums that don't agree, a total that BBODY_T[K] shows to be in another unit.
Spectrum pathRadiance(const Tape7Run& run);

/// Direct sunlight, on a surface that faces it [W/(m2 um)]: at the observer through the air (SOL_TR, SOL@OBS), and above the air (SOLAR, TOA_SUN).
/// Errors: UserError for runs without the sun, or blank columns.
Spectrum sunAtObserver(const Tape7Run& run);
Spectrum sunAboveAir(const Tape7Run& run);

/// Throws UserError, naming both bands, unless the run covers all of a sensor's.
void requireBand(const Tape7Run& run, double low_um, double high_um, const std::string& sensor);

}  // namespace pitviper
