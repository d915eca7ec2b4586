#pragma once
// What a sensor is worth, by its design: the figures that engineers compare.
//   N(T) = fill t scale Omega integral of kernel B(T); NETD = sqrt(N + D + sigma^2 + 1 / (12 gain^2)) / (dN/dT), D: electrons of dark current and of the lens's
//   own light, sigma: noises from frame to frame, with PRNU N, DSNU and fixed rows and columns for the other. MTF: the lens's transfer function times
//   sinc(pitch f), f = 1 / (2 pitch).
// Source: EMVA Standard 1288, release 4.0; NETD as in G. C. Holst, Electro-Optical Imaging System Performance. Valid below saturation.
#include <optional>
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// On the axis.
struct SensorFigures {
  double ifov_rad = 0.0;      ///< a pixel's pitch over the focal length
  double mtfAtNyquist = 1.0;  ///< lens and pixel, at half a cycle a pixel
  double drawnMtf = 1.0;      ///< the same of what is drawn, on cells
  struct Detected {
    double electronsAt300K = 0.0, electrons_per_K = 0.0;
    double netd_K = 0.0;                ///< at 300 K: rms noise of a pixel from frame to frame over d signal/dT
    double netdWithFixed_K = 0.0;       ///< with what is fixed over the film: PRNU, DSNU, rows, columns
    double saturation_K = 0.0;          ///< a black body that fills the well or the converter; 0: hotter than 20000 K
    double noiseEquivalent_W_m2 = 0.0;  ///< irradiance on the aperture, even over the channel's band and all on one pixel, whose signal is the noise at 300 K
    std::string limitedBy;              ///< the largest of the noises at 300 K
  };
  std::optional<Detected> detected;  ///< of an output that a detector makes counts of
};

/// Of one of a camera's outputs; `step_s`: from frame to frame, which 1/f noise depends on; figures "at 300 K" are at `kelvin`.
SensorFigures figuresOf(const Camera& camera, const ChannelOutput& output, double step_s = 1.0 / 30.0, double kelvin = 300.0);

}  // namespace pitviper
