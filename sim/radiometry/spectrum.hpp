#pragma once
// A function of vacuum wavelength: constant, table, black body, or a product of these.
#include <string>
#include <variant>
#include <vector>

namespace pitviper {

/// The spectral axis [um].
constexpr double kShortestWavelength_um = 0.1;
constexpr double kLongestWavelength_um = 1000.0;

/// What a table is outside its wavelengths. A response is Zero; anything else is Error unless it says otherwise.
enum class Outside { Zero, Hold, Error };

/// Asked for a wavelength at which a spectrum has no data.
class OutsideSpectrum;

class Spectrum {
 public:
  struct Constant {
    double value;
  };
  /// Piecewise linear; wavelengths strictly rising [um]. Two equal neighbours are a step (the later value holds from there on).
  struct Table {
    std::vector<double> wavelength_um;
    std::vector<double> value;
    Outside outside = Outside::Error;
    std::string name;  ///< for messages: file:line or library name
  };
  /// scale x Planck radiance at a temperature.
  struct BlackBody {
    double temperature_K;
    double scale;
  };
  using Factor = std::variant<Constant, Table, BlackBody>;

  Spectrum() : Spectrum(0.0) {}
  explicit Spectrum(double constant) : factors_{Constant{constant}} {}
  /// Throws std::invalid_argument where sizes differ, are empty, do not rise or hold a value that is not finite.
  explicit Spectrum(Table table);
  explicit Spectrum(BlackBody body) : factors_{body} {}
  static Spectrum band(double low_um, double high_um, double value = 1.0);

  /// Value at a wavelength [um]; throws OutsideSpectrum where a factor has no data there.
  double operator()(double wavelength_um) const;
  Spectrum operator*(const Spectrum& other) const;
  Spectrum operator*(double scale) const;

  /// Wavelengths at which some factor bends or jumps, rising, within the spectral axis.
  std::vector<double> knots() const;
  /// Range outside which it is zero (tables with Outside::Zero); the whole axis for others.
  double supportLow() const;
  double supportHigh() const;
  /// Range in which every factor has data.
  double validLow() const;
  double validHigh() const;
  bool isZero() const;
  bool isConstant() const;
  /// Smallest and largest value at knots and, for black bodies, over a fine grid of [low, high].
  double minimum(double low_um, double high_um) const;
  double maximum(double low_um, double high_um) const;
  /// Integral over [low, high] [value um]: composite Gauss-Legendre between knots, relative error below 1e-10 for the smooth
  /// factors here.
  double integral(double low_um, double high_um) const;
  const std::vector<Factor>& factors() const { return factors_; }
  const std::string& provenance() const { return provenance_; }
  void setProvenance(std::string text) { provenance_ = std::move(text); }

 private:
  std::vector<Factor> factors_;
  std::string provenance_;
};

}  // namespace pitviper

#include <stdexcept>
namespace pitviper {
class OutsideSpectrum : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
}  // namespace pitviper
