#pragma once
// What draws lines of sight: on GL (ScenePass), or in double precision (ReferenceDrawer). Lines come as views, those through the middles of their pixels.
#include <functional>
#include <vector>

#include "sim/world/view.hpp"

namespace pitviper {

struct ShadowDemand;

/// Integrals of kernel x radiance per subpixel, or per pixel (View::subpixels), as read back. Row 0 is the bottom.
struct RawImage {
  int width = 0, height = 0;
  int subpixels = 1;   ///< so many by so many of the view were resolved into each
  glm::ivec4 kept{0};  ///< corner and size of a part that is there subpixel by subpixel as well
  std::vector<std::vector<float>> keptGroups;
  std::vector<std::vector<float>> groups;  ///< four slots each, RGBA
  std::vector<std::vector<float>> truth;   ///< three layers of RGBA where asked for: sim/render/assembly/glsl/truth_layers.glsl
  std::vector<int> entity;                 ///< what each pixel sees, -1 the background. Empty unless asked for
};

class LineDrawer {
 public:
  LineDrawer() = default;
  virtual ~LineDrawer() = default;
  LineDrawer(const LineDrawer&) = delete;
  LineDrawer& operator=(const LineDrawer&) = delete;
  /// Takes what changes with time: light levels, temperatures, shadows. `demand`: as ShadowPass's; what is not drawn then has no shadows.
  virtual void setState(const WorldState& state, const ShadowDemand* demand = nullptr) = 0;
  /// `drawn`: one flag per entity; the others are left out (small bodies have views of their own).
  virtual void draw(const View& view, const WorldState& state, const std::vector<char>& drawn) = 0;
  /// Starts copying the last drawn image; the caller may do other work before finishReadback(). `identity`: with RawImage::entity.
  virtual void startReadback(bool identity = false) = 0;
  virtual RawImage finishReadback() = 0;
  /// Whether views can be drawn as tiles.
  virtual bool drawsTiles() const { return false; }
  /// Views of one size from one place, each of its own body (View::onlyEntity), as tiles of pictures that are read back as a whole; `take`(view, image).
  virtual void drawTiles(const std::vector<View>&, const WorldState&, const std::vector<char>&, const std::function<void(std::size_t, const RawImage&)>&) {}
};

}  // namespace pitviper
