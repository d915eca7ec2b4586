#pragma once
// The contract of a sensor channel's output: a spectral kernel and the factor that turns its integral into a quantity.
#include <memory>
#include <string>

#include "sim/model/band_temperature.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// pixel value = scale x integral of kernel(lambda) L(lambda) dlambda [x projected solid angle of the pixel, where perEtendue] [x exposure time, where
/// perExposure].
/// The kernel holds response and calibration k(lambda) (and optics and quantum efficiency where the quantity has them).
struct ChannelOutput {
  std::string channel;   ///< "mw"
  std::string quantity;  ///< "radiance"
  std::string unit;      ///< "W/(m2 sr)"
  Location where;
  Spectrum kernel;
  double scale = 1.0;
  bool perEtendue = false, perExposure = false;
  bool detected = false;                                    ///< photoelectrons that a detector makes counts of
  bool asTemperature = false;                               ///< then told as the temperature of a black body whose kernel integral is as large
  std::shared_ptr<const BandTemperature> temperature = {};  ///< of its kernel, where it is
  double bandLow_um = 0.0, bandHigh_um = 0.0;
  std::string cut;  ///< what of its response is left out for want of data, in words; empty: nothing (coverage.hpp)
  std::string layer() const { return channel + "." + quantity; }
};

}  // namespace pitviper
