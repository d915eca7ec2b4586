#include "sim/render/surface/shading_program.hpp"

#include <epoxy/gl.h>

#include <cstdlib>

#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

/// Edge of a compute workgroup [pixels]: as in sim/render/surface/glsl/shade.comp.glsl.
constexpr unsigned kGroup = 8;

}  // namespace

std::string nameOf(ShadingStage stage) { return stage == ShadingStage::Compute ? "compute" : "fragment"; }

ShadingStage chooseShadingStage() {
  const char* wish = std::getenv("PITVIPER_SHADING");
  if (!wish || !*wish) return isSoftware() ? ShadingStage::Fragment : ShadingStage::Compute;
  for (ShadingStage stage : {ShadingStage::Fragment, ShadingStage::Compute})
    if (wish == nameOf(stage)) return stage;
  throw GlError(std::string("PITVIPER_SHADING is '") + wish + "'; it can be fragment or compute");
}

ShadingProgram::ShadingProgram(const ShaderLibrary& library, ShaderSlots slots, const std::vector<std::string>& targets, std::size_t firstColour)
    : stage_(chooseShadingStage()), firstColour_(firstColour), colours_(targets.size()) {
  std::string outputs, store = "void storeTargets(ivec2 at) {\n";
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const std::string number = std::to_string(i);
    if (stage_ == ShadingStage::Fragment) {
      outputs += "layout(location = " + std::to_string(firstColour + i) + ") out vec4 " + targets[i] + ";\n";
    } else {
      outputs += "vec4 " + targets[i] + ";\nlayout(rgba32f, binding = " + number + ") writeonly uniform image2D image" + number + ";\n";
      store += "  imageStore(image" + number + ", at, " + targets[i] + ");\n";
    }
  }
  slots.generated["outputs"] = outputs;
  slots.generated["store"] = store + "}\n";
  const bool fragments = stage_ == ShadingStage::Fragment;
  const AssembledShader shading =
      assembleShader(library, fragments ? "sim/render/surface/glsl/shade.frag.glsl" : "sim/render/surface/glsl/shade.comp.glsl", slots);
  program_ = fragments ? Program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots), shading) : Program(shading);
}

void ShadingProgram::bind(RenderTarget& into, const ChosenPixels& chosen, const glm::ivec4& part) const {
  into.select(firstColour_, colours_);
  into.shareDepth(chosen.classes);
  into.bind();
  into.setPart(part);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDepthFunc(chosen.below ? GL_GREATER : GL_EQUAL);
}

void ShadingProgram::addTo(FirstDraws& draws, RenderTarget& into, const ChosenPixels& chosen) const {
  if (program_.isMade() || stage_ != ShadingStage::Fragment) return;
  bind(into, chosen, glm::ivec4(0));
  draws.add(program_, GL_TRIANGLES);
  glDisable(GL_DEPTH_TEST);
}

void ShadingProgram::run(RenderTarget& into, const ChosenPixels& chosen, const glm::ivec4& part) const {
  program_.use();
  glUniform1f(program_.uniform("classDepth"), chosen.depth);
  if (stage_ == ShadingStage::Fragment) {
    bind(into, chosen, part);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_DEPTH_TEST);
    into.setPart(glm::ivec4(0));
    return;
  }
  glUniform1i(program_.uniform("below"), chosen.below);
  chosen.classes.depth().bind(18);
  for (std::size_t i = 0; i < colours_; ++i)
    glBindImageTexture(static_cast<GLuint>(i), into.colour(firstColour_ + i).name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);  // what was drawn into these textures, and read from them, comes first
  const glm::uvec2 size = part.z > 0 ? glm::uvec2(part.z, part.w) : glm::uvec2(into.width(), into.height());
  glUniform4i(program_.uniform("part"), part.x, part.y, static_cast<int>(size.x), static_cast<int>(size.y));
  glDispatchCompute((size.x + kGroup - 1) / kGroup, (size.y + kGroup - 1) / kGroup, 1);
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
}

}  // namespace pitviper
