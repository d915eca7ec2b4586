#pragma once
// Spectral sampling of a channel: wavelengths and weights with which an integral of kernel(lambda) L(lambda) is a weighted sum.
#include <vector>

#include "sim/radiometry/quadrature.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Gauss: the Gauss rule of the kernel itself (16 points: below 1e-6 for spectra smooth over the band). Even, Log: cells of equal
/// width or equal ratio from edge to edge of the band, sampled in their middle, weighted by the kernel's integral over the
/// cell (error falls with the square of the cell width).
enum class Spacing { Even, Log, Gauss };

/// `kernel` must have a finite band (a response). Weights [kernel unit x um] sum to the kernel's integral.
/// Throws std::invalid_argument where the kernel is zero or the band empty.
std::vector<QuadratureNode> spectralRule(const Spectrum& kernel, int samples, Spacing spacing);

/// The same on cells over [low, high] shared with other channels (Gauss: Legendre points over that range, kernel sampled at them).
std::vector<QuadratureNode> sharedRule(const Spectrum& kernel, int samples, Spacing spacing, double low_um, double high_um);

}  // namespace pitviper
