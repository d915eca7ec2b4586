#pragma once
// Pixels shaded once for all of their subpixels, where that is enough: what each sees near its middle is shaded first; then, subpixel by subpixel, those
// pixels whose subpixels see different parts, or whose radiance bends from neighbour to neighbour, in some channel, by more than a share of itself. Not
// where only textures can make it bend, which are read over whole pixels: light and 1 / depth don't.
// Source: adaptive supersampling after Whitted 1980; the bend in place of the contrast, so that slopes, of which the middle is the mean, need nothing.
#include "sim/gl/objects.hpp"

namespace pitviper {

class SharedShading {
 public:
  /// `groups`: channel groups of four; the target's colours beyond, truth, don't count. `threshold`: the share; `filtered`: textures are read over whole
  /// pixels. `grouped`: subpixels across a pixel. `drawnOver`: something transparent may be.
  SharedShading(const ShaderLibrary& library, int groups, std::size_t colours, double threshold, bool filtered, int grouped, bool drawnOver);
  /// What pixels of a picture see, and its depth.
  void findMiddles(const RenderTarget& subpixels, RenderTarget& pixels);
  /// Which of the shaded pixels are not enough. `before`: the same without what transparent things add to it; null where there are none.
  void findBends(const RenderTarget& subpixels, const RenderTarget& pixels, const Texture2D& smoothness, const RenderTarget& shaded,
                 const RenderTarget* before);
  /// 0 for those that are, 1 + what these need for the others, as findBends() left it.
  const Texture2D& bends() const { return bends_->colour(0); }
  /// Gives subpixels what their pixels have; of a part (corner, size), or of all.
  void spread(const RenderTarget& shaded, RenderTarget& into, const glm::ivec4& part) const;

 private:
  int groups_;
  double threshold_;
  Program middles_, find_, spread_;
  std::optional<RenderTarget> bends_;
};

}  // namespace pitviper
