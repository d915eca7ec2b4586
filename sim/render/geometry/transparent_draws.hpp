#pragma once
// Which of a scenario's transparent surfaces and media a view may show, and how one of them is drawn to find the lines that it meets.
#include <vector>

#include "sim/render/assembly/tables.hpp"
#include "sim/render/geometry/gpu_scene.hpp"
#include "sim/render/geometry/hit_lists.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// Indices of draws. `drawn`: one flag per entity.
std::vector<std::size_t> transparentIn(const std::vector<DrawItem>& items, const Simulation& simulation, const View& view, const WorldState& state,
                                       const std::vector<char>& drawn);
void drawPane(HitLists& hits, const GpuScene& scene, const Simulation& simulation, const DrawItem& item, std::size_t draw);
void drawMedium(HitLists& hits, const GpuScene& scene, const Simulation& simulation, const DrawItem& item, std::size_t draw);

}  // namespace pitviper
