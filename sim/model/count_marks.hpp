#pragma once
// Pixels whose counts say nothing: marked where the detector cuts them, so that no number made of them is taken for a measurement.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/model/detector_law.hpp"

namespace pitviper {

/// By channel: of each pixel, rows from the top, its CountMark.
using CountMarks = std::map<std::string, std::vector<CountMark>>;

}  // namespace pitviper
