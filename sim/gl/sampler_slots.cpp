#include "sim/gl/sampler_slots.hpp"

#include <epoxy/gl.h>

#include <string>

#include "sim/gl/objects.hpp"

namespace pitviper {
namespace {

/// More than programs of this project have; every driver of OpenGL 4.5 has 16 in each stage and 48 in both.
constexpr int kInFragments = 32, kInVertices = 8;

std::string stage(int first, int count, const std::string& begin, const std::string& end) {
  std::string text = "#version 450 core\n", sum = "0.0";
  for (int k = first; k < first + count; ++k) {
    text += "layout(binding = " + std::to_string(k % kInFragments) + ") uniform sampler2D t" + std::to_string(k) + ";\n";
    sum += " + texelFetch(t" + std::to_string(k) + ", ivec2(0), 0).x";
  }
  return text + begin + sum + end;
}

}  // namespace

void setNearest(unsigned texture) {
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void fillSamplerSlots() {
  AssembledShader vertex, fragment;
  vertex.source = stage(kInFragments, kInVertices, "void main() { gl_Position = vec4(", ", 0.0, 0.0, 1.0); }\n");
  fragment.source = stage(0, kInFragments, "out vec4 colour;\nvoid main() { colour = vec4(", "); }\n");
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &most);
  if (most < kInFragments) return;
  GLuint nearest = 0;
  glCreateSamplers(1, &nearest);
  glSamplerParameteri(nearest, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  glSamplerParameteri(nearest, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  for (unsigned k = 0; k < kInFragments; ++k) glBindSampler(k, nearest);
  const Program program(vertex, fragment);
  const VertexArray none = makeVertexArray();
  const Texture2D texture(1, 1, PixelFormat::R32f);
  const RenderTarget target(1, 1, {PixelFormat::R32f}, false);
  target.bind();
  glBindVertexArray(none);
  program.use();
  for (unsigned k = 0; k < kInFragments; ++k) texture.bind(k);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  for (unsigned k = 0; k < kInFragments; ++k) glBindTextureUnit(k, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace pitviper
