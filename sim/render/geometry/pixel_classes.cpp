#include "sim/render/geometry/pixel_classes.hpp"

#include <epoxy/gl.h>

#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

constexpr unsigned kClasses = 18, kBends = 19;

}  // namespace

PixelClasses::PixelClasses(const ShaderLibrary& library, const ShaderSlots& slots)
    : program_(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots),
               assembleShader(library, "sim/render/geometry/glsl/classes.frag.glsl", slots)),
      withLight_(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots),
                 assembleShader(library, "sim/render/geometry/glsl/classes.frag.glsl", slots)),
      again_(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots),
             assembleShader(library, "sim/render/geometry/glsl/classes_again.frag.glsl", slots)),
      cover_(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots),
             assembleShader(library, "sim/render/geometry/glsl/cover.frag.glsl", slots)) {}

void PixelClasses::find(const RenderTarget& visibility) {
  begin(visibility);
  drawPart(glm::ivec4(0));
  end();
}

void PixelClasses::findAgain(const RenderTarget& visibility, const Texture2D& bends, int grouped) {
  begin(visibility, again_, false);
  bends.bind(kBends);
  glUniform1i(again_.uniform("grouped"), grouped);
  drawPart(glm::ivec4(0));
  end();
}

void PixelClasses::findWithLight(const RenderTarget& visibility) {
  begin(visibility, withLight_, true);
  light_ = found_;
  drawPart(glm::ivec4(0));
  end();
}

void PixelClasses::drawPart(const glm::ivec4& part) const {
  found_->setPart(part);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void PixelClasses::end() const {
  found_->setPart(glm::ivec4(0));
  glDisable(GL_DEPTH_TEST);
}

void PixelClasses::cover(RenderTarget& visibility) const {
  found_->depth().bind(kClasses);
  visibility.bind();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_ALWAYS);
  glDisable(GL_BLEND);
  cover_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void PixelClasses::begin(const RenderTarget& visibility, const Program& program, bool withLight) {
  found_ = nullptr;
  for (const RenderTarget& t : targets_)
    if (t.width() == visibility.width() && t.height() == visibility.height() && (t.colourCount() > 0) == withLight) found_ = &t;
  if (!found_)
    found_ = &targets_.emplace_back(visibility.width(), visibility.height(),
                                    withLight ? std::vector<PixelFormat>{PixelFormat::Rgba32f} : std::vector<PixelFormat>{}, true);
  found_->bind();
  visibility.colour(0).bind(0);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  program.use();
}

}  // namespace pitviper
