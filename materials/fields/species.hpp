#pragma once
// Absorbers by species, with their dependence on temperature, as the library's tables have them (materials/library/gases).
#include <filesystem>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

enum class Species { CO2, H2O, CO, Soot, Alumina };

/// A band of a gas: parameters of its curve of growth (materials/fields/k_distribution.hpp) by level of temperature.
struct SpeciesBand {
  double low_per_cm = 0.0, high_per_cm = 0.0;
  std::size_t cells = 1;               ///< the steps it is laid out in
  std::vector<double> mean_per_atm_m;  ///< per partial pressure at the gas's own temperature
  std::vector<double> overlap;
};

/// Absorption, linear in temperature between levels and held beyond them; 0.3 to 30 um.
///   gases              [1/(atm m)]: times partial pressure [atm] = absorption coefficient [1/m]. Total pressure 1 atm.
///   soot               [1/m]:       times volume fraction
///   alumina            [m2/kg]:     times mass of it in a volume [kg/m3]
/// Gases: bands of 25 1/cm (50 beyond 5000), each laid out as its k-distribution in steps whose order is the same at all temperatures of a gas. So the mean
/// over a band is right along paths of one temperature; hot gas behind cold gas of the same species counts as fully correlated (what absorbs most when hot
/// does when cold); gases among each other as uncorrelated. Single wavelengths within a band mean nothing. No lines of the air are correlated with these.
/// Lines are as broad as with 5 % of a gas in air: 11 % of water vapour raises its emissivity by up to 0.02.
/// Errors against RADCAL, from which the gases come (tests/unit/test_species.cpp): emissivity of single bands 0.001 rms, 0.012 at worst, of cameras' bands
/// 0.002; between levels of temperature up to 4 % of it below 700 K, 2.5 % above. RADCAL itself: 10 to 20 % of a band's emissivity.
struct SpeciesTable {
  std::string name;
  std::vector<double> temperature_K;  ///< levels, rising
  std::vector<Spectrum> absorption;   ///< by level
  std::string source;
  std::vector<SpeciesBand> bands;  ///< of gases
};

/// The table of a species in `libraryFolder`/gases, read once. Errors: UserError with file:line:col.
const SpeciesTable& speciesTable(Species, const std::filesystem::path& libraryFolder);
/// Read anew from a file of the same form.
SpeciesTable readSpeciesTable(Species, const std::filesystem::path& file, const Location& askedAt = {});

/// Where a temperature lies between the levels: the lower level and the part of the step above it, within 0..1.
struct BetweenLevels {
  std::size_t lower = 0;
  double part = 0.0;
};
BetweenLevels betweenLevels(const SpeciesTable&, double temperature_K);
/// At one wavelength and temperature. Throws OutsideSpectrum outside 0.3 to 30 um.
double absorptionOf(const SpeciesTable&, double wavelength_um, double temperature_K);

}  // namespace pitviper
