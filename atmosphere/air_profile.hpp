#pragma once
// Pressure, temperature, water vapour and ozone by height: a climate's, or those of a radiosonde.
//
// Files: comma-separated, a header of names and units: altitude [m or km], pressure [hPa], temperature [K], and one of water [ppmv], humidity [%] (relative,
// over water), dew_point [K]; ozone [ppmv] where it is known. Units as scenarios have them (degC, Pa, ft). Rows rising, without holes.
// Between heights temperature is linear, pressure and mixing ratios exponential.
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

struct AirLevel {
  double altitude_m = 0.0, pressure_Pa = 0.0, temperature_K = 0.0;
  double water = 0.0, ozone = 0.0;  ///< mole fractions
};

/// What its lowest level is to have.
struct AirAtGround {
  std::optional<double> temperature_K, pressure_Pa, humidity;  ///< relative, 0 to 1
};

class AirProfile {
 public:
  /// Errors: UserError for rows that do not rise, have holes, humidity over 100 %, dew above the temperature, pressure that does not fall
  /// as the weight of its air says (hypsometric equation, to 15 %), more water than air of that temperature holds.
  /// `above`: goes on where the file ends, and has the ozone that the file lacks.
  static AirProfile read(const std::filesystem::path& file, const Location& askedAt, const AirProfile* above = nullptr);

  const std::vector<AirLevel>& levels() const { return levels_; }  ///< rising
  /// The altitude of the file's last row.
  double soundedTo_m() const { return soundedTo_m_; }
  /// Held below the first and above the last.
  AirLevel at(double altitude_m) const;
  /// Relative humidity over water at the lowest level, 0 to 1.
  double humidity() const;
  /// Nothing is below this height; the lowest level stands there. Heights stay above the sea.
  void cutAt(double altitude_m);
  /// Temperature changes by as much at the ground and less and less up to 11 km, relative humidity below stays as it is or in proportion to the ground's
  /// (100 % at most), pressure follows by its weight.
  void setGround(const AirAtGround& ground);

  /// Of water over a plane of water [Pa]. Source: Alduchov and Eskridge 1996, J. Appl. Meteorol. 35, 601: 0.4 % from -40 to 50 degC.
  static double saturation_Pa(double temperature_K);

 private:
  std::vector<AirLevel> levels_;
  double soundedTo_m_ = 0.0;
};

}  // namespace pitviper
