#pragma once
// A spectral property of a surface that changes with the view angle alone: emissivity or transmittance.
#include <memory>
#include <string>
#include <vector>

#include "sim/model/component.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Values over wavelength and view angle: values[angle * wavelengths + w] at rising wavelengths [um] and equally spaced angles, linear
/// between, held beyond the last angle; without wavelengths there is no table.
struct ViewTable {
  std::vector<double> wavelength_um;
  AngleAxis view;
  std::vector<double> values;
};

/// The same by a model.
class ViewModel {
 public:
  virtual ~ViewModel() = default;
  virtual double at(double wavelength_um, double viewAngle_rad) const = 0;
  /// Where it bends, rising.
  virtual std::vector<double> knots_um() const = 0;
  virtual std::vector<double> knots_rad() const = 0;
  virtual double validLow_um() const = 0;
  virtual double validHigh_um() const = 0;
  /// All that it depends on.
  virtual const std::string& fingerprint() const = 0;
};

/// 0..1: spectrum(lambda) x factor over view angle, a table over both, or a model; times a modifier texture.
struct ViewSpectrum {
  Spectrum spectrum;
  std::vector<double> viewAngle_rad;  ///< rising from 0, or empty: no dependence
  std::vector<double> factor;
  ViewTable table;    ///< instead of the three above, where it has wavelengths
  std::shared_ptr<const ViewModel> model;  ///< instead of all of these, where there is one
  int modifier = -1;  ///< texture index, or -1
  /// Modifier at 1. Throws OutsideSpectrum where the table or the spectrum has no data.
  double at(double wavelength_um, double viewAngle_rad) const;
  bool tabulated() const { return !table.wavelength_um.empty(); }
  bool varies() const { return model || tabulated() || !viewAngle_rad.empty(); }  ///< with view angle
  /// Where it bends, rising.
  std::vector<double> knots_um() const { return model ? model->knots_um() : tabulated() ? table.wavelength_um : spectrum.knots(); }
  std::vector<double> knots_rad() const;
  double validLow_um() const { return model ? model->validLow_um() : tabulated() ? table.wavelength_um.front() : spectrum.validLow(); }
  double validHigh_um() const { return model ? model->validHigh_um() : tabulated() ? table.wavelength_um.back() : spectrum.validHigh(); }
};

}  // namespace pitviper
