#pragma once
// The fixed yardstick that every speed is told against, because machines drift: a bare loop over 16 wavelengths, 16 channels out.
#include "sim/gl/objects.hpp"

namespace pitviper {

/// Set up once, drawn as often as asked. Needs a current GlContext.
class Yardstick {
 public:
  static constexpr int kSize_px = 256;
  Yardstick();
  void draw();

 private:
  VertexArray vertexArray_;
  RenderTarget target_;
  Texture2D constants_;
  GlName<deleteTexture> table_;
  Program program_;
};

}  // namespace pitviper
