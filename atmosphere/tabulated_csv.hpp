#pragma once
// Air by tables from comma-separated values.
//
// Lines beginning with '#' and empty lines are left out. The first other line names the columns, each with its unit, as name_unit or name [unit]:
//   wavelength_um | wavelength_nm | wavenumber_1/cm     rising; a second one of them may stand beside the first, and must agree to 1e-4
//   extinction_1/km | extinction_1/m                    exponential air: no range needed
//   transmittance, with range_km | range_m              one row for each wavelength and range, in any order as long as each range rises
//   transmittance_5km, transmittance_500m ...           or one column for each range
//   optical_depth, optical_depth_5km ...                in place of a transmittance, -ln of it
//   path_radiance_UNIT                                  beside transmittance; path_radiance_5km_UNIT ... where ranges have columns
//   source_radiance_UNIT                                or what the path tends to: path radiance / (1 - transmittance)
//   -                                                   a column to be left out
// UNIT: W/(m2 sr um), W/(cm2 sr um), W/(m2 sr nm), W/(cm2 sr cm-1), W/(m2 sr cm-1) or mW/(m2 sr cm-1). cm-1 may stand for 1/cm. Without a radiance the
// air sends nothing.
//   wavelength_um, range_km, transmittance, path_radiance_W/(m2 sr um)
//   4.0, 1, 0.93, 0.012
// Two or more ranges give a non-negative fit of the powers 0.55, 0.75 and 1 of range at each wavelength; one range an exponential.
#include <filesystem>
#include <istream>
#include <string>

#include "atmosphere/tabulated_air.hpp"

namespace pitviper {

/// `name` is the file in messages. Errors: UserError with line and column, what was expected and the fix.
TabulatedAir readAirCsv(std::istream& in, const std::string& name);
TabulatedAir readAirCsv(const std::filesystem::path& file);

}  // namespace pitviper
