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

/// An interval of wavelength [um].
struct SpectralPiece {
  double low_um, high_um;
};

/// The pieces of the axis between all band edges of several kernels, those in which every kernel is zero left out.
std::vector<SpectralPiece> commonPieces(const std::vector<const Spectrum*>& kernels);

/// Nodes in common with other channels: about `samples` over all pieces, shared out by their widths, at least two in each. Even, Log: cells,
/// weighted by the kernel's integral over each. Gauss: Legendre points, weighted by the kernel there.
/// Throws std::invalid_argument where these weights miss the kernel's integral by more than 1e-3.
std::vector<QuadratureNode> sharedRule(const Spectrum& kernel, int samples, Spacing spacing, const std::vector<SpectralPiece>& pieces);

}  // namespace pitviper
