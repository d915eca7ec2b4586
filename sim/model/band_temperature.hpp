#pragma once
// Apparent temperature: that of a black body of which a channel's integral is as large.
#include <vector>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

class BandTemperature {
 public:
  /// Inverse of T -> integral of kernel(lambda) B(lambda, T) dlambda from low to high, 20 to 20000 K. A table of ln integral over 1/T, in which Wien's law is a
  /// line; within 1e-5 K per kelvin of what it inverts.
  BandTemperature(const Spectrum& kernel, double low_um, double high_um);
  /// [K]; 0 where the integral is 0 or less, or a body of 20 K has more; 20000 K where one of that has no more.
  double operator()(double integral) const;
  /// The integral at a temperature, and its slope [1/K]; of the table.
  double integral(double temperature_K) const;
  double slope(double temperature_K) const;

 private:
  std::vector<double> inverse_, log_;  ///< 1/T falling, ln integral rising
};

}  // namespace pitviper
