#pragma once
// What lines through the middles of a view's pixels meet of surfaces, solid and transparent, as the pictures' own rasteriser tells it.
#include <deque>
#include <memory>
#include <span>

#include "sim/render/geometry/hit_lists.hpp"
#include "sim/render/geometry/solid_pass.hpp"

namespace pitviper {

/// Entity -1: no body.
struct SeenTriangle {
  int entity = -1;
  std::uint32_t triangle = 0;  ///< of its mesh
};

/// Row by row from below.
struct SeenLines {
  std::vector<SeenTriangle> solid;
  std::vector<std::uint32_t> firstPane;  ///< of each line, then the number of all; empty: nothing transparent is in view
  std::vector<SeenTriangle> panes;       ///< in no order: surfaces before what is solid, and all of meshed media
  std::span<const SeenTriangle> panesOf(std::size_t line) const {
    if (firstPane.empty()) return {};
    return {panes.data() + firstPane[line], panes.data() + firstPane[line + 1]};
  }
};

class RasterTracer {
 public:
  /// All but the library must outlive it. Needs a current GlContext.
  RasterTracer(const Simulation& simulation, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  /// `drawn`: one flag per entity.
  SeenLines see(const View& view, const WorldState& state, const std::vector<char>& drawn);

 private:
  bool isMeshed(const DrawItem& item) const;
  SeenTriangle triangleOf(std::uint32_t draw, std::uint32_t triangle) const;
  void addPanes(const RenderTarget& visibility, const View& view, const WorldState& state, const std::vector<char>& drawn, SeenLines& seen);
  const Simulation& simulation_;
  std::shared_ptr<const GpuScene> scene_;
  std::vector<DrawItem> items_;
  SolidPass solids_;
  std::unique_ptr<HitLists> hits_;  ///< null: the scenario has neither transparent surfaces nor meshed media
  Buffer draws_, view_;
  std::deque<RenderTarget> targets_;  ///< by size
  Readback readback_;
};

}  // namespace pitviper
