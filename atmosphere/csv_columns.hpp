#pragma once
// What the columns of a table of air hold, from the line that names them.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper::csv {

struct Cell {
  std::string_view text;  ///< without blanks at either end
  int column = 1;         ///< of its first character, from 1
};

std::vector<Cell> cellsOf(std::string_view line);

enum class Meaning { Wavelength, Wavenumber, Range, Transmittance, Extinction, PathRadiance, SourceRadiance };

struct Column {
  Meaning meaning = Meaning::Wavelength;
  double scale = 1.0;              ///< to um, 1/cm, km, 1/km, W/(m2 sr um)
  bool perWavenumber = false;      ///< a radiance to be multiplied by the squared wavenumber as well
  std::optional<double> range_km;  ///< where the name has it
  std::string name;                ///< as written
  int column = 1;
};

/// Errors: UserError for unknown names, missing or unknown units, columns that come twice, and sets of columns that are no air.
std::vector<Column> columnsOf(std::string_view header, const Location& line);

}  // namespace pitviper::csv
