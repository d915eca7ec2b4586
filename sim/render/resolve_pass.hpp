#pragma once
// Subpixels resolved into pixels: the mean over each pixel's, weighted by their projected solid angles (flux adds up), or, of truth, the one near its middle.
#include "sim/gl/objects.hpp"
#include "sim/gl/shader_assembler.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

/// Pixels that were shaded as one: their colours, and a texture that is 0 where these are enough.
struct SharedPixels {
  const RenderTarget& shaded;
  const Texture2D& bends;
};

class ResolvePass {
 public:
  /// Of the first `colours` of a picture the first `means` are averaged, the others taken from the middle.
  ResolvePass(const ShaderLibrary& library, std::size_t colours, std::size_t means);
  /// What was drawn for a view of View::subpixels x View::subpixels to a pixel. `shared`: null where all subpixels were shaded.
  const RenderTarget& run(const RenderTarget& subpixels, const View& view, const SharedPixels* shared);

 private:
  std::size_t colours_;
  Program program_;
  std::optional<RenderTarget> pixels_;
  Texture2D none_{3, 3, PixelFormat::R32f};  ///< in the place of SharedPixels::bends
};

}  // namespace pitviper
