#pragma once
// A spectral image: mean spectral radiance at the aperture over neighbouring bins of wavelength, to be looked at, or integrated later by
// any sensor. Source: the buffered mode of Duvenhage 2006 section 4.6.2, whose render target holds binned wavelength samples.
#include <filesystem>

#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Frame::kind of one.
inline constexpr const char* kSpectralKind = "spectral";

struct SpectralImage {
  std::string file;
  int width = 0, height = 0;
  std::vector<double> edge_um;           ///< one more than bins, rising
  std::vector<std::vector<float>> bins;  ///< [bin][pixel], row 0 at the top [W/(m2 sr um)]
  Pinhole pinhole;
  double exposure_s = 0.0;            ///< 0: the camera said none
  std::vector<Attribute> attributes;  ///< of the picture as a whole: where, when, of what
};

/// The output whose integral is a bin's mean: a box of height 1/width. Layers are named "S0.3050nm" after its middle.
ChannelOutput binOutput(const SpectralBins& bins, int bin);

/// Of every bin: wavelength_um (centre) and bin_um (edges, exact) as attributes; and those of the layout for spectral images that layers are named after.
void addBins(Frame& frame, const SpectralBins& bins);

/// Errors: UserError with the file name if it cannot be read, has no bins, bins that overlap or leave gaps, or lacks the camera's attributes.
SpectralImage readSpectralImage(const std::filesystem::path& file);

}  // namespace pitviper
