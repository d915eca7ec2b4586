#include "sim/render/resolve_pass.hpp"

#include <epoxy/gl.h>

namespace pitviper {
namespace {

/// Texture units: colours of the subpixels, of the pixels, and which of these are not enough. Up to four groups of channels and three of truth.
constexpr unsigned kSubpixels = 0, kPixels = 8, kBends = 19;

std::string colourOf(std::size_t i, const std::string& how) {
  const std::string n = std::to_string(i);
  return "  colour" + n + " = enough ? texelFetch(pixels" + n + ", p, 0) : " + how + "(subpixels" + n + ", p);\n";
}

std::string resolveText(std::size_t colours, std::size_t means) {
  std::string declared, main = "void main() {\n  ivec2 p = ivec2(gl_FragCoord.xy);\n  bool enough = isShared && texelFetch(bends, p, 0).x == 0.0;\n";
  for (std::size_t i = 0; i < colours; ++i) {
    const std::string n = std::to_string(i);
    declared += "layout(location = " + n + ") out vec4 colour" + n + ";\nlayout(binding = " + std::to_string(kSubpixels + i) + ") uniform sampler2D subpixels" +
                n + ";\nlayout(binding = " + std::to_string(kPixels + i) + ") uniform sampler2D pixels" + n + ";\n";
    main += colourOf(i, i < means ? "meanOf" : "middleOf");
  }
  return declared + main + "}\n";
}

Program programFor(const ShaderLibrary& library, std::size_t colours, std::size_t means) {
  ShaderSlots slots;
  slots.generated["resolve"] = resolveText(colours, means);
  return Program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots),
                 assembleShader(library, "sim/render/glsl/resolve.frag.glsl", slots));
}

}  // namespace

ResolvePass::ResolvePass(const ShaderLibrary& library, std::size_t colours, std::size_t means)
    : colours_(colours), program_(programFor(library, colours, means)) {}

const RenderTarget& ResolvePass::run(const RenderTarget& subpixels, const View& v, const SharedPixels* shared) {
  const int width = v.width / v.subpixels, height = v.height / v.subpixels;
  if (!pixels_ || pixels_->width() != width || pixels_->height() != height)
    pixels_.emplace(width, height, std::vector<PixelFormat>(colours_, PixelFormat::Rgba32f), false);
  for (std::size_t i = 0; i < colours_; ++i) {
    subpixels.colour(i).bind(kSubpixels + static_cast<unsigned>(i));
    (shared ? shared->shaded : subpixels).colour(i).bind(kPixels + static_cast<unsigned>(i));
  }
  (shared ? shared->bends : none_).bind(kBends);  // llvmpipe would compile again for another kind of texture, or none
  pixels_->bind();
  program_.use();
  glUniform1i(program_.uniform("isShared"), shared != nullptr);
  glUniform1i(program_.uniform("across"), v.subpixels);
  glUniform4f(program_.uniform("film"), static_cast<float>(v.tanPerPixelX), static_cast<float>(v.tanPerPixelY), static_cast<float>(v.axisX),
              static_cast<float>(v.axisY));
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return *pixels_;
}

}  // namespace pitviper
