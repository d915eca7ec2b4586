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

/// Between commas.
std::vector<Cell> cellsOf(std::string_view line);
/// Between blanks.
std::vector<Cell> wordsOf(std::string_view line);

/// The lines of a text, without what ends them.
using Lines = std::vector<std::string_view>;
Lines linesOf(std::string_view text);

enum class Meaning { Wavelength, Wavenumber, Range, Transmittance, Extinction, PathRadiance, SourceRadiance, LeftOut };

struct Column {
  Meaning meaning = Meaning::Wavelength;
  double scale = 1.0;              ///< to um, 1/cm, km, 1/km, W/(m2 sr um)
  bool perWavenumber = false;      ///< a radiance to be multiplied by the squared wavenumber as well
  bool isDepth = false;            ///< a transmittance given as its optical depth
  std::optional<double> range_km;  ///< where the name has it
  std::string name;                ///< as written
  int column = 1;
};

/// Names between commas; '-' is a column to be left out. `where`: of the first character.
/// Errors: UserError for unknown names, missing or unknown units, and columns that come twice.
std::vector<Column> namesOf(std::string_view header, const Location& where);
/// Errors: UserError for sets of columns that are no air.
void requireAir(const std::vector<Column>& columns, const Location& where);

}  // namespace pitviper::csv
