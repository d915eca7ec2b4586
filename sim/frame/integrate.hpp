#pragma once
// Sensors applied to a spectral image after it was drawn: value = scale x sum over bins of L_k K_k [x projected solid angle], with the bin's
// mean radiance L_k and K_k = integral of the kernel over the bin, exact. The kernel meets a spectrum that is flat in each bin.
#include "sim/frame/spectral_image.hpp"

namespace pitviper {

/// What that flatness costs, to first order: |sum_k s_k m_k| / value, with s_k the slope of the pixel's spectrum between the bins beside k and
/// m_k = integral of kernel (lambda - centre) over bin k. It is 0 where the kernel is flat over every bin it meets; structure of the spectrum
/// narrower than a bin is not in it.
struct BinningError {
  double median = 0.0, maximum = 0.0;  ///< over pixels with a value other than 0
};

/// Both sums over bins as weights of the bins' means.
struct BinWeights {
  std::vector<double> value, error;
};
BinWeights binWeights(const Spectrum& kernel, const std::vector<double>& edge_um);

struct IntegratedFrame {
  Frame frame;                        ///< camera, time and metadata of the image
  std::vector<BinningError> binning;  ///< one per layer; also the attributes binning_error.<layer> (median, maximum)
};

/// The pinhole has the image's pixels. Errors: UserError at the output's place where the bins do not cover its kernel.
IntegratedFrame integrateSpectralImage(const SpectralImage& image, const std::vector<ChannelOutput>& outputs, const Pinhole& pinhole, double exposure_s);

}  // namespace pitviper
