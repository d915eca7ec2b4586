#include "scenarios/commands/bench_yardstick.hpp"

#include <epoxy/gl.h>

#include "scenarios/commands/commands.hpp"

namespace pitviper {

std::span<const ShaderText> pv_commands_shaders();

Yardstick::Yardstick()
    : vertexArray_(makeVertexArray()),
      target_(kSize_px, kSize_px, std::vector<PixelFormat>(4, PixelFormat::Rgba32f), false),
      constants_(16, 5, PixelFormat::Rgba32f) {
  ShaderLibrary library;
  library.add(pv_commands_shaders());
  ShaderSlots none;
  program_ = Program(assembleShader(shaderLibrary(), "sim/render/geometry/glsl/full_screen.vert.glsl", none),
                     assembleShader(library, "scenarios/commands/glsl/yardstick.glsl", none));
  std::vector<float> table(16 * 32 * 32 * 4);
  for (size_t i = 0; i < table.size(); ++i) table[i] = 0.1f + 0.001f * static_cast<float>(i % 97);
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  table_ = GlName<deleteTexture>(name);
  glTextureStorage3D(name, 1, GL_RGBA32F, 16, 32, 32);
  glTextureSubImage3D(name, 0, 0, 0, 0, 16, 32, 32, GL_RGBA, GL_FLOAT, table.data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  std::vector<float> constants(16 * 5 * 4, 0.3f);
  glTextureSubImage2D(constants_.name(), 0, 0, 0, 16, 5, GL_RGBA, GL_FLOAT, constants.data());
}

void Yardstick::draw() {
  target_.bind();
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(vertexArray_);
  glBindTextureUnit(0, table_);
  constants_.bind(1);
  program_.use();
  glUniform2f(program_.uniform("angles"), 0.3f, 0.4f);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace pitviper
