// Programs that several threads make together: all are made, nothing reaches a pixel, the context's state stays, and one that is wrong is told by its lines.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>
#include <thread>

#include "sim/gl/context.hpp"
#include "sim/gl/driver_cache.hpp"
#include "sim/gl/first_draws.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

AssembledShader text(const std::string& body) {
  AssembledShader shader;
  shader.source = "#version 450 core\n" + body;
  shader.origin.assign(512, "told.glsl:7");
  return shader;
}

const std::string kEverywhere = "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.5, 1.0); gl_PointSize = 1.0; }\n";

/// Each of a text of its own that no cache has, and that takes a while to compile.
Program programOf(int number, const std::string& wrong = "") {
  static const unsigned never = std::random_device()();
  std::string sum = "float never = float(" + std::to_string(never) + "u);\nfloat s = 0.0;\n";
  for (int k = 0; k < 400; ++k) sum += "s += sin(texelFetch(read, ivec2(" + std::to_string(k % 3) + ", 0), 0).r * never + " + std::to_string(k) + ".0);\n";
  return Program(text(kEverywhere),
                 text("layout(location = 0) out vec4 colour;\nlayout(binding = 3) uniform sampler2D read;\nuniform float added;\nvoid main() {" + wrong + sum +
                      "colour = vec4(texelFetch(read, ivec2(0), 0).r + added + 0.0 * s + " + std::to_string(number) + ".0); }\n"));
}

bool isCompiledByThreads() { return isSoftware() && driverKeepsPrograms() && std::thread::hardware_concurrency() > 1; }

int asked(GLenum what) {
  GLint value = 0;
  glGetIntegerv(what, &value);
  return value;
}

TEST(FirstDraws, MakesAllAndDrawsNothing) {
  needContext();
  if (!isCompiledByThreads()) GTEST_SKIP() << "one core, a GPU or no cache of programs: each is made at its first use";
  const VertexArray none = makeVertexArray();
  glBindVertexArray(none);
  RenderTarget target(9, 9, {PixelFormat::Rgba32f}, true);
  Texture2D read(3, 3, PixelFormat::R32f);
  read.upload(std::vector<float>(9, 0.25f));
  target.bind();
  const GLfloat kept[4] = {7.0f, 7.0f, 7.0f, 7.0f};
  glClearBufferfv(GL_COLOR, 0, kept);
  read.bind(3);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  std::deque<Program> programs;
  FirstDraws first;
  for (int k = 0; k < 6; ++k) {
    programs.push_back(programOf(k));
    first.add(programs.back(), k % 2 ? GL_POINTS : GL_TRIANGLES);
    EXPECT_FALSE(programs.back().isMade());
  }
  first.add(programs.back(), GL_POINTS);  // the same again
  const std::array states{GL_DRAW_FRAMEBUFFER_BINDING, GL_DEPTH_FUNC, GL_DEPTH_WRITEMASK, GL_SCISSOR_TEST, GL_BLEND, GL_CLIP_DEPTH_MODE};
  std::vector<int> before, after;
  for (GLenum s : states) before.push_back(asked(s));
  const long made = programsSoFar().programs;
  first.make();
  for (GLenum s : states) after.push_back(asked(s));
  EXPECT_EQ(after, before);
  EXPECT_GE(programsSoFar().programs - made, 6);
  EXPECT_LE(programsSoFar().programs - made, 6 + 5) << "and one of its own for each context that helps";
  checkGl("first draws");
  for (const Program& p : programs) EXPECT_TRUE(p.isMade());
  Readback readback;
  readback.start(target, 1);
  const auto pixels = readback.wait();
  for (float v : pixels.colours[0]) ASSERT_EQ(v, 7.0f);
  // What another thread has made draws here, with this context's uniforms.
  for (int k = 0; k < 6; ++k) {
    programs[static_cast<size_t>(k)].use();
    glUniform1f(programs[static_cast<size_t>(k)].uniform("added"), 0.5f);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    readback.start(target, 1);
    const auto own = readback.wait();
    for (float v : own.colours[0]) ASSERT_EQ(v, 0.75f + static_cast<float>(k));
  }
  glDisable(GL_DEPTH_TEST);
}

TEST(FirstDraws, TellsOfAWrongProgramWhereItIsUsed) {
  needContext();
  const VertexArray none = makeVertexArray();
  glBindVertexArray(none);
  RenderTarget target(9, 9, {PixelFormat::Rgba32f}, false);
  target.bind();
  for (const bool atEnd : {false, true}) {
    const Program good = programOf(100 + atEnd), wrong = programOf(200, "\nno such word;\n");
    FirstDraws first;
    first.add(atEnd ? good : wrong, GL_TRIANGLES);
    first.add(atEnd ? wrong : good, GL_TRIANGLES);
    try {
      first.make();
    } catch (const GlError&) {
    }
    EXPECT_NO_THROW(good.use());
    try {
      wrong.use();
      FAIL() << "a text that no compiler takes";
    } catch (const GlError& e) {
      EXPECT_NE(std::string(e.what()).find("told.glsl:7"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace pitviper::test
