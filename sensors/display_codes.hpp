#pragma once
// Counts as codes for a screen. For people only: what they say depends on the rest of the picture.
#include <vector>

#include "sim/model/detector_law.hpp"

namespace pitviper {

/// 0 to 255.
///   Linear: from 0 to the highest count. Percentile: from the 0.5 to the 99.5 percentile of the picture. Plateau: by the picture's histogram, no bin of
///   which counts for more than a plateau of 2 % of the pixels (Source: V. E. Vickers, Opt. Eng. 35, 1921 (1996)).
void toDisplayCodes(std::vector<float>& counts, const DetectorLaw& law);

}  // namespace pitviper
