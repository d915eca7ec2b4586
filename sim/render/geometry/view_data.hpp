#pragma once
// What the shaders know of a view and of the bodies in it, as they read it.
#include <cstdint>
#include <span>
#include <vector>

#include "sim/render/assembly/tables.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// Mirrors Draw of sim/render/assembly/glsl/draws.glsl.
struct GpuDraw {
  glm::vec4 row[3];
  glm::uvec4 table;
  glm::vec4 state;
  glm::vec4 fine;
};
static_assert(sizeof(GpuDraw) == 96);

/// Texture unit of the buffer that has it.
constexpr unsigned kViewUnit = 29;

/// Mirrors View of sim/render/assembly/glsl/view_block.glsl.
struct GpuView {
  glm::vec4 pixel, film, depth, up, earth, sun, aperture, east, north;
  glm::vec4 shade[3];  ///< for sim/render/surface/glsl/sun_shade_clouds.glsl: axes of SunShadeGrid in the camera frame, the camera's place on them
};
static_assert(sizeof(GpuView) == 192);

/// `corner`: where the view's lower left stands in the picture [pixels].
GpuView viewData(const Simulation& simulation, const View& view, double apertureArea_m2, glm::ivec2 corner = {0, 0});
GpuDraw drawData(const Simulation& simulation, const DrawItem& item, const View& view, const WorldState& state);

}  // namespace pitviper
