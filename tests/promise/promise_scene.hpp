#pragma once
// One scenario, drawn at some accuracies and by the reference at the same subpixels, all pixels compared.
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/commands/accuracy_renderings.hpp"

namespace pitviper::test {

struct PromisePixel : ComparedPixel {
  double planned = 0.0, reference = 0.0;  ///< integral of kernel x radiance
};

/// A channel at an accuracy.
struct PromiseCell {
  std::uint64_t seed = 0;
  std::string channel;
  double asked = 0.0, predicted = 0.0;
  double ofWavelengths = 0.0, ofTables = 0.0;  ///< parts of what is predicted
  double extremes = 0.0;                       ///< reported apart
  double found = 0.0;                          ///< largest of |L - Lref| / max(Lref, 1e-3 x 99th percentile of Lref); infinite where a pixel is not a number
  double beyond = 0.0;                         ///< share of pixels that are farther off than asked
  int groups = 0, wavelengths = 0;
  PromisePixel worst;
};

struct PromiseScene {
  std::uint64_t seed = 0;
  std::string text;                           ///< of the scenario
  int pixels = 0;                             ///< compared, of all frames
  int negative = 0;                           ///< pixels below 0, planned or reference, all channels
  double reference_s = 0.0, planned_s = 0.0;  ///< time taken
  std::vector<PromiseCell> cells;
};

/// Throws UserError where the scenario is refused. Plans are not shared with any other call. `automatic`: with samples: auto, against all of 2 x 2 subpixels.
PromiseScene keepPromise(std::uint64_t seed, const std::string& scenario, const std::vector<double>& accuracies, bool automatic = false);

}  // namespace pitviper::test
