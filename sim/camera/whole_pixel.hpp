#pragma once
// Pixels as they would be without subpixels, prefiltered textures, zoomed views and tables: what the geometry of a picture is held against.
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"

namespace pitviper {

/// Means over a pixel, and what they may be off by.
struct WholePixel {
  std::vector<double> mean;   ///< [slot], as CameraImage::slots
  std::vector<double> error;  ///< standard error of the mean, by quarters of the places
};

class WholePixels {
 public:
  /// At the plan's own wavelengths, so that what they are off by is not counted twice. All must outlive it.
  WholePixels(const Simulation& simulation, const Camera& camera, const Plan& plan, std::uint64_t seed);
  /// Of a picture's pixel (row by row from the top): 32 x 32 rays, one at random in each cell (Cook 1986), each through everything in double precision.
  /// None where a lamp is in view within a pixel of it: a point has no mean.
  std::optional<WholePixel> look(const WorldState& state, int pixel) const;

 private:
  const Simulation& simulation_;
  const Camera& camera_;
  const Plan& plan_;
  std::uint64_t seed_;
  std::shared_ptr<const NodeSpectra> spectra_;
};

/// Counter-based: the same numbers for the same number, whatever was drawn before. Source: Steele, Lea and Flood 2014 (SplitMix64).
std::uint64_t mixed(std::uint64_t x);

}  // namespace pitviper
