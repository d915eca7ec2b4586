#include "sim/render/shared_shading.hpp"

#include <epoxy/gl.h>

namespace pitviper {
namespace {

/// The pixels' colours, a texture each from here on; what subpixels see.
constexpr unsigned kColours = 22, kSubpixels = 18, kSmoothness = 17, kBefore = 26;

/// Colours copied one to one.
std::string spreadText(std::size_t colours) {
  std::string declared, copied;
  for (std::size_t i = 0; i < colours; ++i) {
    const std::string n = std::to_string(i);
    declared +=
        "layout(location = " + n + ") out vec4 colour" + n + ";\nlayout(binding = " + std::to_string(kColours + i) + ") uniform sampler2D pixels" + n + ";\n";
    copied += "  colour" + n + " = texelFetch(pixels" + n + ", p, 0);\n";
  }
  return declared + "void main() {\n  ivec2 p = ivec2(gl_FragCoord.xy) / GROUPED;\n" + copied + "}\n";
}

void drawAll(const Program& program, const RenderTarget& into, const glm::ivec4& part = glm::ivec4(0)) {
  into.bind();
  into.setPart(part);
  program.use();
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  into.setPart(glm::ivec4(0));
}

}  // namespace

SharedShading::SharedShading(const ShaderLibrary& library, int groups, std::size_t colours, double threshold, bool filtered, int grouped,
                             bool drawnOver)
    : groups_(groups), threshold_(threshold) {
  ShaderSlots slots;
  slots.constants["GROUPS"] = groups;
  slots.constants["FILTERED"] = filtered ? 1 : 0;
  slots.constants["GROUPED"] = grouped;
  slots.constants["DRAWN_OVER"] = drawnOver ? 1 : 0;
  const AssembledShader everywhere = assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots);
  middles_ = Program(everywhere, assembleShader(library, "sim/render/glsl/pixel_middle.frag.glsl", slots));
  find_ = Program(everywhere, assembleShader(library, "sim/render/glsl/pixel_bends.frag.glsl", slots));
  slots.generated["spread"] = spreadText(colours);
  spread_ = Program(everywhere, assembleShader(library, "sim/render/glsl/pixel_spread.frag.glsl", slots));
}

void SharedShading::findMiddles(const RenderTarget& subpixels, RenderTarget& pixels) {
  subpixels.colour(0).bind(0);
  subpixels.depth().bind(kSubpixels);
  pixels.bind();
  middles_.use();
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_ALWAYS);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_DEPTH_TEST);
}

void SharedShading::findBends(const RenderTarget& subpixels, const RenderTarget& pixels, const Texture2D& smoothness, const RenderTarget& shaded,
                              const RenderTarget* before) {
  if (!bends_ || bends_->width() != pixels.width() || bends_->height() != pixels.height())
    bends_.emplace(pixels.width(), pixels.height(), std::vector<PixelFormat>{PixelFormat::R32f}, false);
  pixels.colour(0).bind(0);
  subpixels.colour(0).bind(kSubpixels);
  smoothness.bind(kSmoothness);
  for (int g = 0; g < groups_; ++g) {
    shaded.colour(static_cast<std::size_t>(g)).bind(kColours + static_cast<unsigned>(g));
    (before ? *before : shaded).colour(static_cast<std::size_t>(g)).bind(kBefore + static_cast<unsigned>(g));
  }
  find_.use();
  glUniform1f(find_.uniform("threshold"), static_cast<float>(threshold_));
  glUniform1i(find_.uniform("drawnOver"), before != nullptr);
  glUniform2i(find_.uniform("last"), pixels.width() - 1, pixels.height() - 1);
  drawAll(find_, *bends_);
}

void SharedShading::spread(const RenderTarget& shaded, RenderTarget& into, const glm::ivec4& part) const {
  for (std::size_t i = 0; i < shaded.colourCount(); ++i) shaded.colour(i).bind(kColours + static_cast<unsigned>(i));
  into.select(0, into.colourCount());
  drawAll(spread_, into, part);
}

}  // namespace pitviper
