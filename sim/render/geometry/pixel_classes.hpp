#pragma once
// Which class each pixel of a picture is of, kept as depth: a pass over the whole film that is tested against it shades the pixels of one class alone.
// Source: deferred shading's usual material depth; measured on llvmpipe, where every branch runs both ways and only depth or stencil skip.
#include <deque>

#include "sim/gl/objects.hpp"

namespace pitviper {

/// Pixels that a pass draws.
struct ChosenPixels {
  const RenderTarget& classes;
  float depth;  ///< of the class that is drawn ...
  bool below;   ///< ... or all classes below that depth
};

class PixelClasses {
 public:
  /// `slots`: those of shading.
  PixelClasses(const ShaderLibrary& library, const ShaderSlots& slots);
  /// Of what was drawn last. Buffers and the view are bound.
  void find(const RenderTarget& visibility);
  /// Of pixels of grouped x grouped subpixels, those of which SharedShading::bends() has 0 are left out.
  void findAgain(const RenderTarget& visibility, const Texture2D& bends, int grouped);
  /// The same, and what their light depends on: smoothness().
  void findWithLight(const RenderTarget& visibility);
  /// As the last findWithLight() left it: (light, 1 / depth [1/m]) where a pixel's radiance is smooth where these are, but for its textures; else (-1, 0).
  const Texture2D& smoothness() const { return light_->colour(0); }
  /// The same part by part (corner, size), with views of their own.
  void begin(const RenderTarget& visibility) { begin(visibility, program_, false); }
  void drawPart(const glm::ivec4& part) const;
  void end() const;
  /// Gives what was left out the nearest depth of all in `visibility`, so that nothing is drawn over it.
  void cover(RenderTarget& visibility) const;
  ChosenPixels only(std::size_t surfaceClass) const { return {*found_, depthOf(surfaceClass), false}; }
  /// All but what a view of one body leaves out.
  ChosenPixels all() const { return {*found_, 0.5f * (depthOf(0) + 1.0f), true}; }
  /// Exact in single precision, of up to 15 classes. The first lies behind the others, and what no class has behind it.
  static float depthOf(std::size_t surfaceClass) { return surfaceClass == 0 ? 15.0f / 16.0f : static_cast<float>(surfaceClass) / 16.0f; }

 private:
  void begin(const RenderTarget& visibility, const Program& program, bool withLight);
  Program program_, withLight_, again_, cover_;  // two of one text: llvmpipe finds only the first of a program's states in its cache
  std::deque<RenderTarget> targets_;
  const RenderTarget *found_ = nullptr, *light_ = nullptr;
};

}  // namespace pitviper
