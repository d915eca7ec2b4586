#pragma once
// Lines of sight of a target, of which a few stand for all.
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

namespace pitviper {

struct TargetLine {
  std::size_t things;            ///< that it meets: between lines of the same number radiance changes smoothly
  glm::dvec2 at;                 ///< on the target's grid
  double sr;                     ///< that it stands for
  std::vector<double> contrast;  ///< by slot
};

/// Lines of the same things (or of many that are little each), from the darkest to the brightest, that have a share of the contrast.
struct Stratum {
  const TargetLine* line;        ///< in its middle
  double sr;                     ///< of all of them
  std::vector<double> contrast;  ///< of all of them, by slot: over solid angle
};

/// About `shares` strata of as much contrast each, whatever its sign, all slots alike; one at least of each kind of things that has a quarter of a share, and
/// of the others together: five times as many as shares at most, and one. They point into `lines`.
std::vector<Stratum> strataOf(const std::vector<TargetLine>& lines, int shares);

}  // namespace pitviper
