#pragma once
// A layer in a window: its pixels, overlays, colour bar; where on it the mouse is.
#include <imgui.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/view/layer_look.hpp"

namespace pitviper {

/// What part of a picture is shown; the same for all tiles.
struct TileZoom {
  double factor = 1.0;          ///< 1: all of it
  glm::dvec2 middle{0.5, 0.5};  ///< of the picture's sides
};

/// Outlines and boxes of what a picture's entity layer tells.
struct EntityShape {
  int entity = -1;
  int left = 0, top = 0, right = 0, bottom = 0, pixels = 0;  ///< right and bottom: one beyond
  double nearest_m = 0.0;
};
struct EntityShapes {
  std::vector<EntityShape> shapes;
  std::vector<glm::ivec4> edges;  ///< from, to: corners of pixels
  static EntityShapes of(const Frame& frame);
};

class PictureTile {
 public:
  PictureTile() = default;
  ~PictureTile();
  PictureTile(const PictureTile&) = delete;
  PictureTile& operator=(const PictureTile&) = delete;

  void load(LayerPicture picture, int width, int height);
  /// Colours alone, of a composite.
  void load(const std::string& title, const std::vector<Rgb8>& colours, int width, int height);
  /// Draws it into a room of the window; the mouse is looked at with `id`.
  void draw(const std::string& id, ImVec2 size, TileZoom& zoom);

  ImVec2 at(double column, double row) const;
  glm::dvec2 placeOf(ImVec2 screen) const;
  std::optional<glm::ivec2> pixelUnder(ImVec2 screen) const;
  bool isHovered() const { return hovered_; }
  bool isActive() const { return active_; }
  ImVec2 low() const { return low_; }
  ImVec2 high() const { return high_; }
  const LayerPicture& picture() const { return picture_; }
  double pixelSize() const { return scale_; }

 private:
  void upload(const std::vector<Rgb8>& colours, int width, int height);
  void drawBar(ImVec2 low, ImVec2 high) const;
  LayerPicture picture_;
  bool hasBar_ = false;
  unsigned texture_ = 0;
  int width_ = 0, height_ = 0;
  ImVec2 low_, high_, origin_;  ///< of the room; where pixel 0,0 begins
  double scale_ = 1.0;
  bool hovered_ = false, active_ = false;
};

}  // namespace pitviper
