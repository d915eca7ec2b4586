#pragma once
// Where a rasteriser and a ray may disagree on what is seen through: the outlines of transparent things.
#include "sim/model/view.hpp"

namespace pitviper {

/// Something transparent begins or ends within a fiftieth of a pixel of the middle of pixel (x, y), counted from the lower left.
/// `drawn`: one flag per entity.
bool onOutline(const Simulation& simulation, const WorldState& state, const View& view, const std::vector<char>& drawn, int x, int y);

/// Something transparent begins or ends somewhere in pixel (x, y), as far as a grid of lines tells.
bool outlineWithin(const Simulation& simulation, const WorldState& state, const View& view, const std::vector<char>& drawn, int x, int y);

}  // namespace pitviper
