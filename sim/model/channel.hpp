#pragma once
// The contract of a sensor channel's output: a spectral kernel and the factor that turns its integral into a quantity.
#include <memory>
#include <optional>
#include <string>

#include "sim/model/band_temperature.hpp"
#include "sim/parameters/error.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// What a channel's kernel is made of, for those who read its frames.
struct ChannelCurves {
  Spectrum response;                                ///< dimensionless
  Spectrum optics{1.0};                             ///< transmission of the camera's optics
  std::optional<Spectrum> quantumEfficiency = {};   ///< photoelectrons per photon
};

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
  bool behindOptics = false;                                ///< of the light on the film: lenses take from it and add to it
  Spectrum onFilm;                                          ///< then the kernel of light that does not pass the optics
  double onFilmScale = 1.0;                                 ///< as `scale`
  bool detected = false;                                    ///< photoelectrons that a detector makes counts of
  bool asTemperature = false;                               ///< then told as the temperature of a black body whose kernel integral is as large
  bool asSignalToNoise = false, asDisplay = false;          ///< of what is detected: its mean over its noise; codes for a screen
  bool asMark = false;                                      ///< why a count says nothing (CountMark)
  std::shared_ptr<const BandTemperature> temperature = {};  ///< of its kernel, where that is asked for (asTemperature, detected)
  double bandLow_um = 0.0, bandHigh_um = 0.0;
  std::shared_ptr<const ChannelCurves> curves = {};  ///< in the frame's header; none: nothing
  std::string cut;  ///< what of its response is left out for want of data, in words; empty: nothing (coverage.hpp)
  /// What the detector counts, told as it is.
  bool isCount() const { return detected && !asTemperature && !asSignalToNoise && !asDisplay && !asMark; }
  /// Whose exposure and detector it has, where those are not the camera's; it then shares no integral with other channels, as what moves differs.
  std::string apart;
  std::string layer() const { return channel + "." + quantity; }
};

}  // namespace pitviper
