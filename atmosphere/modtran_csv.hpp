#pragma once
// MODTRAN 6's comma-separated output (FILEOPTIONS: CSVPRNT; NAME.csv).
//
// Lines before the names of the columns are left out, and one of units behind them; then a row for each wavenumber, and a last line that is none:
//   freq,total transmittance,path emission,path thermal scat,surface emission,path multiple scat,path single scat,ground reflect,direct reflect,
//   total radiance,reference irradiance,irradiance at observer,- nat log path trans,directional emissivity,top-of-atmosphere irradiance,brightness temp
// The names may be those of a tape7 or of MODTRAN's JSON as well. The file says nothing of its path: it is one run of unknown direction, whose range the user
// gives. Wavenumbers only (XFLAG W), so W/(cm2 sr cm-1); that is checked by the brightness temperature. Refused: several cases in one file.
// Source: the order of the columns and lines around the rows that are none as https://github.com/FangcaoXu/2_MODTRANData_Processing_Hyperspectral
// (Data_2_csv2matrix.R) reads them; the names are those of the same spectra in MODTRAN 6's other outputs (modtran_names.hpp), so they are tried on no file.
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/tape7.hpp"

namespace pitviper {

bool isModtranCsv(std::string_view text);

/// `name` is the file in messages. Errors: UserError with line and column.
std::vector<Tape7Run> parseModtranCsv(std::string_view text, const std::string& name);

}  // namespace pitviper
