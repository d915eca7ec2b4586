#pragma once
// What lines through the middles of a view's pixels see of solid bodies, as the pictures' own rasteriser tells it.
#include <deque>

#include "sim/render/solid_pass.hpp"

namespace pitviper {

/// Entity -1: no body.
struct SeenTriangle {
  int entity = -1;
  std::uint32_t triangle = 0;  ///< of its mesh
};

class RasterTracer {
 public:
  /// All but the library must outlive it. Needs a current GlContext.
  RasterTracer(const Simulation& simulation, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  /// Row by row from below. `drawn`: one flag per entity.
  std::vector<SeenTriangle> see(const View& view, const WorldState& state, const std::vector<char>& drawn);

 private:
  const Simulation& simulation_;
  std::shared_ptr<const GpuScene> scene_;
  std::vector<DrawItem> items_;
  SolidPass solids_;
  Buffer draws_, view_;
  std::deque<RenderTarget> targets_;  ///< by size
  Readback readback_;
};

}  // namespace pitviper
