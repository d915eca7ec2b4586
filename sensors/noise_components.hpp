#pragma once
// The three-dimensional noise model, from a run of frames of a flat field.
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace pitviper {

/// Variances, in the order of kNoiseNames. A pixel of frame t, row v, column h is the mean plus independent parts of each.
/// Source: J. D'Agostino and C. Webb, Proc. SPIE 1488, 110 (1991).
constexpr std::array<const char*, 7> kNoiseNames{"sigma_t", "sigma_v", "sigma_h", "sigma_tv", "sigma_th", "sigma_vh", "sigma_tvh"};

/// A component [the pictures' unit, rms], and its standard error (of normal noise).
struct NoiseComponent {
  double sigma = 0.0, error = 0.0;
};

class NoiseCube {
 public:
  NoiseCube(std::size_t width, std::size_t height) : width_(width), height_(height) {}
  void add(std::vector<float> frame) { frames_.push_back(std::move(frame)); }
  std::size_t frames() const { return frames_.size(); }
  double mean() const;
  /// rms from frame to frame of a pixel, over all pixels.
  double temporal() const;
  /// Unbiased: of each mean over some directions its variance less what finer parts leave in it, none below 0. Needs two frames, rows and columns or more.
  std::array<NoiseComponent, 7> components() const;

 private:
  std::size_t width_, height_;
  std::vector<std::vector<float>> frames_;
};

}  // namespace pitviper
