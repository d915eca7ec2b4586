#pragma once
// Air known from tables along level paths: measured, or computed by MODTRAN.
//
// Law: -ln tau(lambda, R) = sum over k of c_k(lambda) R^a_k,   L_path(lambda, R) = J(lambda) (1 - tau(lambda, R)).
//   R range [km]; c_k optical depth of the first kilometre, linear in wavelength between the table's own wavelengths; a_k exponents common to all
//   of them, < 1 for bands of lines; J source radiance [W/(m2 sr um)], what the path tends to where nothing passes.
// Valid: along paths like those of the table (same height, same direction, the sun where it was), between its ranges; the form goes on outside.
// Two legs in this air: add their ranges before the power, as absorber_table.hpp has it.
// Read from: tabulated_tape7.hpp, tabulated_csv.hpp.
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/parameters/fingerprint.hpp"

namespace pitviper {

/// Radiance of the sky by elevation, as seen from one place.
class TabulatedSky {
 public:
  struct View {
    double elevation_rad = 0.0;
    std::vector<double> radiance;  ///< at each wavelength [W/(m2 sr um)]
  };
  /// Throws std::invalid_argument unless wavelengths rise, there is a view, and all sizes agree.
  TabulatedSky(std::vector<double> wavelength_um, std::vector<View> views);

  /// Linear in relative air mass between two elevations (Kasten and Young 1989), the nearest outside; throws OutsideSpectrum.
  double radiance(double wavelength_um, double elevation_rad) const;
  /// Rising in elevation.
  std::span<const View> views() const { return views_; }
  std::span<const double> knots_um() const { return wavelength_um_; }

 private:
  std::vector<double> wavelength_um_;
  std::vector<View> views_;
};

/// How far the form is from the numbers it was made of.
struct TableFit {
  double largest = 0.0;   ///< difference of transmittance
  double rms = 0.0;       ///< the same, all rows
  double radiance = 0.0;  ///< largest difference of path radiance, of the largest path radiance
};

class TabulatedAir {
 public:
  struct Data {
    std::string file;                        ///< for messages
    int line = 0;                            ///< where it says which wavelengths it has
    std::string description;                 ///< what was read and how it was made into this form, for people
    std::vector<double> wavelength_um;       ///< two or more, rising
    std::vector<double> exponents;           ///< 0 < a <= 1
    std::vector<std::vector<double>> depth;  ///< [wavelength][exponent], >= 0
    std::vector<double> sourceRadiance;      ///< one per wavelength, or none: air that sends nothing
    std::optional<TabulatedSky> sky;
    double shortest_m = 0.0;  ///< ranges of the table
    double longest_m = std::numeric_limits<double>::infinity();
    TableFit fit;
  };
  /// Throws std::invalid_argument where the data break what is said above.
  explicit TabulatedAir(Data data);

  std::span<const double> exponents() const { return data_.exponents; }
  std::span<const double> knots_um() const { return data_.wavelength_um; }
  double validLow_um() const { return data_.wavelength_um.front(); }
  double validHigh_um() const { return data_.wavelength_um.back(); }
  double shortestRange_m() const { return data_.shortest_m; }
  double longestRange_m() const { return data_.longest_m; }
  const std::string& description() const { return data_.description; }
  const std::string& file() const { return data_.file; }
  int line() const { return data_.line; }  ///< where the file says which wavelengths it has
  const TableFit& fit() const { return data_.fit; }
  /// All that paths depend on.
  void addTo(Fingerprint& f) const;
  bool emits() const { return !data_.sourceRadiance.empty(); }
  const std::optional<TabulatedSky>& sky() const { return data_.sky; }

  /// Per exponent the optical depth of the first kilometre, so per km^a_k. This and those below throw OutsideSpectrum outside valid...().
  std::vector<double> coefficients(double wavelength_um) const;
  double sourceRadiance(double wavelength_um) const;
  double opticalDepth(double wavelength_um, double range_m) const;
  double transmittance(double wavelength_um, double range_m) const;
  double pathRadiance(double wavelength_um, double range_m) const;

  /// Throws UserError, naming both bands, unless the table covers all of a sensor's.
  void requireBand(double low_um, double high_um, const std::string& sensor) const;

 private:
  Data data_;
};

}  // namespace pitviper
