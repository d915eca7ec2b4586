#pragma once
// What air sends along a line of sight at one node, written out by itself with the C library's functions: NodeAir is held against it.
#include <span>
#include <vector>

#include "sim/radiance/sunlit_air.hpp"

namespace pitviper::test {

/// As far as each station [W/(m2 sr um)].
struct AirRadiance {
  std::vector<double> depth;
  std::vector<double> thermal;          ///< emission of all extinction, and AirNode::source
  std::vector<double> molecules, haze;  ///< scattered sunlight for phase functions and irradiance of 1; empty: no sun
};

/// `source`: per station, radiance of a black body of its temperature at the node (0 where it has none).
AirRadiance airRadiance(const AirNode& node, const SunlitAir& air, std::span<const double> source);

}  // namespace pitviper::test
