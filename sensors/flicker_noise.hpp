#pragma once
// Noise whose density falls as 1/f, pixel by pixel, from frame to frame.
#include <array>
#include <cstdint>
#include <vector>

#include "sensors/noise_source.hpp"
#include "sim/model/detector_law.hpp"

namespace pitviper {

/// A sum over octaves: the k-th is white noise that holds for 2^k frames, all of one variance, so that what an octave of frequencies has of it is the same.
///   variance of an octave: integral of 2 (sigma^2 / f_s) f_c / f df over it = 2 sigma^2 (f_c / f_s) ln 2, f_c the corner, f_s frames a second
///   (DetectorLaw::flickerVariance)
/// Source: R. F. Voss and J. Clarke, J. Acoust. Soc. Am. 63, 258 (1978), appendix. Valid from 2^-kOctaves of the frame rate to half of it; below that even.
/// What a frame has depends on its number alone; frames in their order are fastest, as most of what they are made of is at hand from the one before.
class FlickerNoise {
 public:
  static constexpr int kOctaves = DetectorLaw::kFlickerOctaves;
  FlickerNoise(std::uint64_t seed, std::uint32_t channel, std::size_t pixels) : seed_(seed), channel_(channel), pixels_(pixels) {}
  /// Of variance 1 an octave.
  const std::vector<float>& at(int frame);

 private:
  /// Pixels change at different frames, in so many sets, or all would jump at once.
  static constexpr int kSets = 16;
  std::uint64_t seed_;
  std::uint32_t channel_;
  std::size_t pixels_;
  std::vector<std::vector<float>> octaves_;
  std::array<std::array<long long, kSets>, kOctaves> block_{};
  std::vector<float> sum_;
};

}  // namespace pitviper
