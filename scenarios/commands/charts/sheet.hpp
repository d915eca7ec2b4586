#pragma once
// All panels on one picture, drawn off screen.
#include <vector>

#include "scenarios/commands/charts.hpp"
#include "sim/image/picture.hpp"

namespace pitviper {

/// Makes a GlContext of its own, current on this thread until it returns. Throws std::exception where it fails.
Rgb8Image drawSheet(const std::vector<Chart>& charts, int columns);

}  // namespace pitviper
