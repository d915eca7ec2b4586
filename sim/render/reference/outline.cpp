#include "sim/render/reference/outline.hpp"

#include <algorithm>

#include "sim/model/ray_hits.hpp"

namespace pitviper {
namespace {

/// Everything transparent on a line of sight, as far as it goes.
std::vector<std::pair<int, int>> seenThrough(const Simulation& sim, const WorldState& state, const View& view, const std::vector<char>& drawn, double x,
                                             double y) {
  const glm::dvec3 ray = view.ray(x, y);
  const RayHits hits = castRay(sim, state, view.position, view.localFromCamera * ray / glm::length(ray), view.near_m * glm::length(ray), &drawn, true, 0);
  std::vector<std::pair<int, int>> all;
  for (const Hit& h : hits.layers) all.emplace_back(h.entity, h.surface);
  for (const Stretch& s : hits.stretches) all.emplace_back(s.entity, -1);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

bool onOutline(const Simulation& sim, const WorldState& state, const View& view, const std::vector<char>& drawn, int x, int y) {
  if (!sim.hasTransparent()) return false;
  const auto middle = seenThrough(sim, state, view, drawn, x + 0.5, y + 0.5);
  for (const auto& [dx, dy] : {std::pair{0.02, 0.02}, {-0.02, 0.02}, {0.02, -0.02}, {-0.02, -0.02}})
    if (seenThrough(sim, state, view, drawn, x + 0.5 + dx, y + 0.5 + dy) != middle) return true;
  return false;
}

bool outlineWithin(const Simulation& sim, const WorldState& state, const View& view, const std::vector<char>& drawn, int x, int y) {
  constexpr int kLines = 5;
  const auto middle = seenThrough(sim, state, view, drawn, x + 0.5, y + 0.5);
  for (int j = 0; j < kLines; ++j)
    for (int i = 0; i < kLines; ++i)
      if (seenThrough(sim, state, view, drawn, x + i / (kLines - 1.0), y + j / (kLines - 1.0)) != middle) return true;
  return false;
}

}  // namespace pitviper
