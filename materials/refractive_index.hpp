#pragma once
// Complex refractive indices n + ik over wavelength: constants, tables, and the formulas that optical constants are published as.
#include <array>
#include <complex>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "sim/parameters/fingerprint.hpp"
#include "sim/parameters/model_record.hpp"

namespace pitviper {

/// Light goes as exp(i (n + ik) 2 pi x / lambda - i omega t): k >= 0 absorbs.
class RefractiveIndex {
 public:
  /// n = a + b / lambda^2 + c / lambda^4 ..., lambda in um.
  struct Cauchy {
    std::vector<double> terms;
  };
  /// n^2 = constant + sum of B lambda^2 / (lambda^2 - C), C in um^2.
  struct Sellmeier {
    double constant = 1.0;
    std::vector<std::array<double, 2>> terms;
  };
  /// (n + ik)^2 = constant + sum of f plasma^2 / (resonance^2 - E^2 - i E width), E the photon's energy; all energies in eV. A resonance of 0 is Drude's
  /// free electrons. Source: A. D. Rakic et al., Appl. Opt. 37, 5271 (1998), equations 1 to 3.
  struct Oscillators {
    double constant = 1.0, plasma_eV = 0.0;
    std::vector<std::array<double, 3>> terms;  ///< f, width, resonance
  };
  /// n and k by themselves; k joins Cauchy's and Sellmeier's.
  RefractiveIndex(Spectrum n, Spectrum k);
  RefractiveIndex(std::variant<Cauchy, Sellmeier, Oscillators> formula, Spectrum k, double low_um, double high_um);

  /// Throws OutsideSpectrum where there is no data.
  std::complex<double> operator()(double wavelength_um) const;
  double validLow_um() const { return low_um_; }
  double validHigh_um() const { return high_um_; }
  /// Where it bends, rising.
  std::vector<double> knots_um() const;
  void addTo(Fingerprint& fingerprint) const;

 private:
  std::variant<Spectrum, Cauchy, Sellmeier, Oscillators> real_;
  Spectrum k_;
  double low_um_, high_um_;
};

/// How an index may be written; for the key reference.
const ParameterTable& refractiveIndexTable();

/// A named substance's file as a tree; UserError at the place where it is asked for.
using SubstanceOf = std::function<Value(const std::string& name, const Location& askedAt)>;

/// A number (of a medium that does not absorb), a name, or a map of refractiveIndexTable(). UserError where n is not above 0 or k is negative anywhere.
RefractiveIndex readRefractiveIndex(const Value& value, const SpectrumOf& spectrumOf, const SubstanceOf& substanceOf);

}  // namespace pitviper
