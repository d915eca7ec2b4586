#pragma once
// Aerosols by name: extinction, albedo and asymmetry by wavelength, by relative humidity or wind; drops and crystals by size. Files:
// atmosphere/library/aerosols/*.csv.
//
// Law: between humidities ln of extinction, of what is absorbed and asymmetry are linear in ln(100 - humidity); between winds ln of both are linear in the
//   wind, between radii in ln(radius); between wavelengths all are linear.
// Source: as LOWTRAN 7 has them (Kneizys et al. 1988, AFGL-TR-88-0177); drops and crystals: at the head of their files.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// At rising wavelengths.
struct AerosolOptics {
  std::vector<double> wavelength_um, extinction, albedo, asymmetry;  ///< extinction: over that at 0.55 um
  double knownLow_um = 0.0, knownHigh_um = INFINITY;                 ///< beyond these nobody may ask
  struct At {
    double extinction = 0.0, albedo = 0.0, asymmetry = 0.0;
  };
  /// Held beyond the ends.
  At at(double wavelength_um) const;
};

/// rural, urban, maritime, tropospheric, desert, advection_fog, radiation_fog.
const std::vector<std::string>& aerosolTypes();
/// Fogs may be thicker than haze.
bool isFog(const std::string& type);
/// Of desert dust the wind counts, of all others the humidity.
bool goesByWind(const std::string& type);

/// `humidity` 0 to 1, held at 0.99; `wind_m_s` at 30 m/s. Errors: UserError for a file that is not there or damaged.
AerosolOptics aerosolOf(const std::string& type, double humidity, double wind_m_s, const std::filesystem::path& library, const Location& askedAt);
/// `water_drops` or `ice_crystals` of an effective radius, the mean by area. The same.
AerosolOptics dropsOf(const std::string& kind, double radius_um, const std::filesystem::path& library, const Location& askedAt);

}  // namespace pitviper
