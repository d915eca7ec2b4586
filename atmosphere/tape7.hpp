#pragma once
// Runs of MODTRAN: transmittance, radiance or solar irradiance along one line of sight, at the wavenumbers of a run; and the tape7 that holds them.
// MODTRAN 6's other files (modtran_files.hpp) give the same runs.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// What a run computed (IEMSCT of card 1).
enum class Tape7Kind { Transmittance = 0, ThermalRadiance = 1, SolarRadiance = 2, SolarIrradiance = 3 };

/// ITYPE of card 1.
enum class Tape7Path { Horizontal = 1, Slant = 2, ToSpace = 3 };

/// Card 3, as far as it means something: a horizontal path leaves all but h1 and range absent, MODEL 0 all.
struct Tape7Geometry {
  Tape7Path path = Tape7Path::Horizontal;
  std::optional<double> h1_km;       ///< the observer
  std::optional<double> h2_km;       ///< the end of the path, its tangent height or the top of the air
  std::optional<double> zenith_deg;  ///< at h1
  std::optional<double> range_km;
  std::optional<double> earthCentreAngle_deg;
  std::optional<int> longPath;  ///< LENN: 1 is the path through the tangent height
};

/// What a column holds, and so its unit: "" for transmittance, emissivity and optical depth.
enum class Tape7Quantity { Transmittance, Emissivity, OpticalDepth, Radiance, Irradiance, Temperature, Unknown };

/// W/(m2 sr um), W/(m2 um), K, "" or "as written" for a column this reader doesn't know.
const char* unitOf(Tape7Quantity quantity);

struct Tape7Column {
  std::string name;  ///< as in the file with '_' for blanks: TOT_TRANS, SOL@OBS; of transmittance runs with their second line: H2O_CONT
  Tape7Quantity quantity = Tape7Quantity::Unknown;
  std::vector<double> value;  ///< rising in wavelength; NaN where the file is blank
  int firstColumn = 0;        ///< in the file, for messages
  int line = 0;               ///< where all its values follow one another (JSON); 0: each has a line
  int gapLine = 0;            ///< first line in which it is blank; 0: none
};

struct Tape7Run {
  std::string file;
  int number = 1;  ///< in the file, from 1
  int line = 1;    ///< of card 1; card 4 and the first row of data stand at:
  int bandLine = 0;
  int dataLine = 0;

  Tape7Kind kind = Tape7Kind::Transmittance;
  char bandModel = ' ';  ///< as in card 1: T, M or blank MODTRAN's, C or K its correlated k, F or L LOWTRAN's 20 cm-1
  int model = 0;         ///< MODEL of card 1: 1 tropical ... 6 US standard 1976, 0, 7, 8 the user's
  std::string title;     ///< of the model atmosphere; "" where the header doesn't say
  int haze = 0;          ///< IHAZE of card 2
  std::optional<double> visibility_km;
  std::optional<double> boundaryTemperature_K;  ///< TPTEMP, where above zero
  std::string surface;                          ///< SURREF: an albedo or a word
  Tape7Geometry geometry;
  double from_per_cm = 0.0, to_per_cm = 0.0, step_per_cm = 0.0, resolution_per_cm = 0.0;  ///< card 4: V1, V2, DV, FWHM; 0 where it is not in cm-1

  double resolution = 0.0;  ///< what the last digit of a transmittance is worth; 0: a tape7's own, 1e-4 in transmittance runs, else 1e-8

  std::vector<double> wavelength_um;  ///< strictly rising
  std::vector<Tape7Column> columns;   ///< those the run computed; a column blank throughout is absent

  const Tape7Column* find(std::string_view name) const;
  /// Where a column's value stands in the file.
  Location placeOf(const Tape7Column& column, size_t i) const {
    return {file, column.line > 0 ? column.line : dataLine + static_cast<int>(wavelength_um.size() - 1 - i), column.firstColumn, -1};
  }
};

/// All runs of a tape7. Spectral densities are turned from wavenumber [W/(cm2 cm-1)] to wavelength [W/(m2 um)]: a factor of the squared
/// wavenumber in cm-1. Errors: UserError with line and column for whatever is not a whole, undamaged tape7. `name`: the file in messages.
std::vector<Tape7Run> parseTape7(std::string_view text, const std::string& name);

}  // namespace pitviper
