#pragma once
// Black bodies at wavelengths and over bands, and integrals of tables over bands: for those who ask in arrays.
//
// Source: Planck's law (sim/radiometry/glsl/planck.glsl) with the exact constants of SI 2019. Every function throws UserError, at its own name, for entries
// that are not finite, are negative or lie outside 0.1 to 1000 um, and for arrays whose lengths differ.
#include <span>
#include <vector>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// What light is counted in: W, or photon/s.
enum class LightUnit { Watts, Photons };

/// Spectral radiance of black bodies, [temperature x wavelengths + wavelength] [W/(m2 sr um)], [photon/(s m2 sr um)]. 0 at 0 K. Relative error 1e-12.
std::vector<double> planckRadiance(std::span<const double> wavelength_um, std::span<const double> temperature_K, LightUnit unit = LightUnit::Watts);

/// Its slope dB/dT, laid out alike [W/(m2 sr um K)], [photon/(s m2 sr um K)].
std::vector<double> planckSlope(std::span<const double> wavelength_um, std::span<const double> temperature_K, LightUnit unit = LightUnit::Watts);

/// How strongly a detector responds over wavelength, dimensionless: of what is integrated with it the unit stays.
class Responsivity {
 public:
  /// 1 between two wavelengths, 0 outside.
  Responsivity(double low_um, double high_um);
  /// A table: linear between its wavelengths, two equal ones a step, 0 outside.
  Responsivity(std::span<const double> wavelength_um, std::span<const double> value);
  /// Of a channel (ChannelCurves, ChannelOutput::kernel): with data wherever it is not 0, and above 0 somewhere.
  explicit Responsivity(Spectrum spectrum);

  const Spectrum& spectrum() const { return spectrum_; }
  /// Outside these it is 0.
  double low_um() const { return spectrum_.supportLow(); }
  double high_um() const { return spectrum_.supportHigh(); }
  double integral_um() const { return spectrum_.integral(low_um(), high_um()); }

 private:
  Spectrum spectrum_;
};

/// integral of S(lambda) B(lambda, T) dlambda for each temperature [W/(m2 sr)], [photon/(s m2 sr)]. Gauss's rule between all bends of S: relative error below
/// 1e-10.
std::vector<double> bandRadiance(std::span<const double> temperature_K, const Responsivity& band, LightUnit unit = LightUnit::Watts);

/// Its slope dL/dT [W/(m2 sr K)], [photon/(s m2 sr K)].
std::vector<double> bandRadianceSlope(std::span<const double> temperature_K, const Responsivity& band, LightUnit unit = LightUnit::Watts);

/// Temperature of the black body that has so much of a band [K]: the inverse of bandRadiance(), as cameras tell it (BandTemperature), then a step of Newton's
/// on the integral itself: relative error below 1e-8. From 20 to 20000 K; 0 of less, 20000 of more.
std::vector<double> apparentTemperature(std::span<const double> radiance, const Responsivity& band, LightUnit unit = LightUnit::Watts);

/// integral of a table, linear between its wavelengths [unit of the values x um]. Exact but for rounding.
double bandIntegral(std::span<const double> wavelength_um, std::span<const double> values);

/// integral of S(lambda) times a table. Both linear between their own wavelengths: exact but for rounding. UserError where S responds outside the table.
double bandIntegral(std::span<const double> wavelength_um, std::span<const double> values, const Responsivity& band);

/// The same over the integral of S: the mean that a detector sees [unit of the values].
double bandMean(std::span<const double> wavelength_um, std::span<const double> values, const Responsivity& band);

}  // namespace pitviper
