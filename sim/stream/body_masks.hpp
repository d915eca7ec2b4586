#pragma once
// Where bodies stand in a picture, pixel by pixel, as detectors are trained with.
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"

namespace pitviper {

/// The pixels of truth.entity that have a body's number.
struct BodyMask {
  int number = 0;                                ///< of the body: its index in Simulation::entities plus one
  std::vector<std::uint32_t> runs;               ///< column by column from the top left corner: pixels that are not its, pixels that are, and so on
  int left = 0, top = 0, right = 0, bottom = 0;  ///< the box around them: columns [left, right), rows [top, bottom)
  std::size_t pixels = 0;
  double range_m = NAN, temperature_K = NAN;  ///< means over them of truth.range and truth.temperature; NaN where the frame has none
};

/// Of all bodies that are wanted and have a pixel, by number. Empty where the frame has no layer truth.entity.
std::vector<BodyMask> bodyMasks(const Frame& frame, const std::function<bool(int number)>& isWanted);

/// COCO's compressed text of runs: each, from the fourth on less the one two before it, in groups of five bits, lowest first, with a sixth that says whether
/// there are more, as characters from '0' on. Source: rleToString of the COCO API's maskApi.c (Dollar and Lin, 2015), whose masks are column by column too.
std::string cocoCounts(const std::vector<std::uint32_t>& runs);

}  // namespace pitviper
