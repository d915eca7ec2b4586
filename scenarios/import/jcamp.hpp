#pragma once
// JCAMP-DX spectra in plain numbers.
#include <string>

#include "scenarios/import/number_lines.hpp"

namespace pitviper {

/// Whether its first line is a labelled record of JCAMP-DX ("##TITLE=").
bool isJcamp(const std::string& text);

/// Its records as head, rows [x, y] with their factors. (XY..XY) and (X++(Y..Y)) in numbers as they are (AFFN); UserError at its line for packed ones, for
/// rows whose x is not where FIRSTX, LASTX and NPOINTS put it, and for a number of points that is another than NPOINTS.
/// Source: R. S. McDonald and P. A. Wilks, JCAMP-DX: a standard form for exchange of infrared spectra in computer readable form, Appl. Spectrosc. 42, 151
/// (1988).
NumberLines readJcamp(const std::string& text, const std::string& file);

}  // namespace pitviper
