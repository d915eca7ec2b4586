#pragma once
// What a detector remembers of frames before: lag, and the slow warming of a bolometer.
#include <cstdint>
#include <map>
#include <vector>

#include "sim/model/detector_law.hpp"

namespace pitviper {

/// Shares of this frame's signal, of the one before, and so on; their sum is 1.
///   lag a: s_n = (1 - a) x_n + a s_(n-1); warming with time constant t, light steady from frame to frame: the same with a = exp(-step / t); both one after
///   the other. Cut where less than 1e-5 is left, which the last of them gets.
/// A finite sum, not a recursion: a frame's signal depends on so many frames before it and no others, so it is the same alone and in a run.
/// Source (bolometer as a first-order system): P. W. Kruse, Uncooled Thermal Imaging (SPIE, 2001).
std::vector<double> memoryWeights(const DetectorLaw& law, double step_s);

/// Pictures of the last frames of each channel.
class SignalMemory {
 public:
  /// The picture of a frame becomes what a detector of these weights has of it. Frames come one after the other: after a gap nothing is remembered, and
  /// the oldest there is stands for those before.
  void apply(std::uint32_t channel, int frame, const std::vector<double>& weights, std::vector<float>& picture);

 private:
  struct Kept {
    int last = 0;
    std::vector<std::vector<float>> pictures;  ///< the newest first
  };
  std::map<std::uint32_t, Kept> kept_;
};

}  // namespace pitviper
