#pragma once
// Media whose boxes overlap are blended together, so that a hot core in a cooler sheath, or puffs that have grown into each other, are right.
#include <vector>

#include "sim/render/layer_order.hpp"

namespace pitviper {

/// Members of one group at most: as GROUP in sim/render/glsl/volume_group.frag.glsl. More that hang together stay single.
constexpr int kMostMembers = 8;

/// Joins pieces that are media with a true form (not meshed ones) where their boxes overlap: the first member's piece stays, its box grown
/// around all in the first one's axes and its form that box; the draws of all, the first one first, go to `groups`, and the piece's
/// `group` tells which.
void joinMedia(std::vector<LayerPiece>& pieces, std::vector<std::vector<std::uint32_t>>& groups);

}  // namespace pitviper
