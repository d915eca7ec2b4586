#include "sim/gl/draw_state.hpp"

#include <epoxy/gl.h>

namespace pitviper {
namespace {

/// Units of textures and images and targets that programs here use; every driver has as many.
constexpr GLuint kUnits = 32, kImages = 8, kTargets = 8;

int asked(GLenum what) {
  GLint value = 0;
  glGetIntegerv(what, &value);
  return value;
}

void set(GLenum what, bool on) {
  if (on) glEnable(what);
  else glDisable(what);
}

}  // namespace

DrawState::DrawState()
    : framebuffer_(asked(GL_DRAW_FRAMEBUFFER_BINDING)),
      depthFunc_(asked(GL_DEPTH_FUNC)),
      blendFrom_(asked(GL_BLEND_SRC_RGB)),
      blendInto_(asked(GL_BLEND_DST_RGB)),
      clipOrigin_(asked(GL_CLIP_ORIGIN)),
      clipDepth_(asked(GL_CLIP_DEPTH_MODE)) {
  const auto framebuffer = static_cast<GLuint>(framebuffer_);
  const auto addTarget = [&](GLenum point) {
    GLint type = GL_NONE, name = 0;
    glGetNamedFramebufferAttachmentParameteriv(framebuffer, point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
    if (type != GL_TEXTURE) return;
    glGetNamedFramebufferAttachmentParameteriv(framebuffer, point, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &name);
    targets_.push_back({point, static_cast<unsigned>(name)});
  };
  for (GLuint k = 0; framebuffer != 0 && k < kTargets; ++k) {
    addTarget(GL_COLOR_ATTACHMENT0 + k);
    drawBuffers_.push_back(static_cast<unsigned>(asked(GL_DRAW_BUFFER0 + k)));
  }
  if (framebuffer != 0) {
    addTarget(GL_DEPTH_ATTACHMENT);
    glGetNamedFramebufferParameteriv(framebuffer, GL_FRAMEBUFFER_DEFAULT_WIDTH, &emptySize_[0]);
    glGetNamedFramebufferParameteriv(framebuffer, GL_FRAMEBUFFER_DEFAULT_HEIGHT, &emptySize_[1]);
  }
  const GLint active = asked(GL_ACTIVE_TEXTURE);
  for (GLuint unit = 0; unit < kUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    for (GLenum kind : {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_BUFFER})
      if (const int name = asked(kind); name != 0) textures_.emplace_back(unit, static_cast<unsigned>(name));
  }
  glActiveTexture(static_cast<GLenum>(active));
  for (GLuint unit = 0; unit < kImages; ++unit) {
    Image image{unit, 0, 0, 0};
    glGetIntegeri_v(GL_IMAGE_BINDING_NAME, unit, &image.texture);
    glGetIntegeri_v(GL_IMAGE_BINDING_ACCESS, unit, &image.access);
    glGetIntegeri_v(GL_IMAGE_BINDING_FORMAT, unit, &image.format);
    if (image.texture != 0) images_.push_back(image);
  }
  for (GLenum test : {GL_DEPTH_TEST, GL_BLEND, GL_DEPTH_CLAMP, GL_CLIP_DISTANCE0, GL_PROGRAM_POINT_SIZE, GL_CULL_FACE, GL_SCISSOR_TEST})
    tests_.emplace_back(test, glIsEnabled(test) == GL_TRUE);
  glGetIntegerv(GL_VIEWPORT, viewport_.data());
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask_);
  glGetBooleanv(GL_COLOR_WRITEMASK, colourMask_.data());
}

void DrawState::apply() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
  applyRest();
}

void DrawState::applyElsewhere(unsigned framebuffer) const {
  for (GLuint k = 0; k < kTargets; ++k) glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0 + k, 0, 0);
  glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, 0, 0);
  for (const Target& t : targets_) glNamedFramebufferTexture(framebuffer, t.point, t.texture, 0);
  glNamedFramebufferParameteri(framebuffer, GL_FRAMEBUFFER_DEFAULT_WIDTH, emptySize_[0]);
  glNamedFramebufferParameteri(framebuffer, GL_FRAMEBUFFER_DEFAULT_HEIGHT, emptySize_[1]);
  glNamedFramebufferDrawBuffers(framebuffer, static_cast<GLsizei>(drawBuffers_.size()), drawBuffers_.data());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  applyRest();
}

void DrawState::applyRest() const {
  for (const auto& [unit, name] : textures_)
    if (glIsTexture(name)) glBindTextureUnit(unit, name);  // a buffer that has grown since has another
  for (const Image& i : images_)
    glBindImageTexture(i.unit, static_cast<GLuint>(i.texture), 0, GL_FALSE, 0, static_cast<GLenum>(i.access), static_cast<GLenum>(i.format));
  for (const auto& [test, on] : tests_) set(test, on);
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glDepthFunc(static_cast<GLenum>(depthFunc_));
  glBlendFunc(static_cast<GLenum>(blendFrom_), static_cast<GLenum>(blendInto_));
  glClipControl(static_cast<GLenum>(clipOrigin_), static_cast<GLenum>(clipDepth_));
  glDepthMask(depthMask_);
  glColorMask(colourMask_[0], colourMask_[1], colourMask_[2], colourMask_[3]);
}

}  // namespace pitviper
