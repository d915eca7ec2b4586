#include "sim/camera/sensor_stage.hpp"

#include <epoxy/gl.h>

#include <stdexcept>

#include "sim/gl/context.hpp"

namespace pitviper {

std::vector<float>& SensorPictures::values(std::size_t output) {
  if (onGpu_)
    for (std::size_t o = 0; o < values_.size(); ++o) now_[o].colour(0).download(values_[o]);
  onGpu_ = false;
  return values_[output];
}

void SensorPictures::toGpu() {
  if (now_.empty())
    for (std::size_t o = 0; o < values_.size(); ++o)
      for (auto* targets : {&now_, &next_}) targets->emplace_back(width, height, std::vector{PixelFormat::R32f}, false);
  for (std::size_t o = 0; !onGpu_ && o < values_.size(); ++o) now_[o].colour(0).upload(values_[o]);
  onGpu_ = true;
}

const Texture2D& SensorPictures::now(std::size_t output) {
  toGpu();
  return now_[output].colour(0);
}

RenderTarget& SensorPictures::next(std::size_t output) {
  toGpu();
  return next_[output];
}

FormulaStage::FormulaStage(const ShaderLibrary& library, const std::string& file, std::vector<float> parameters)
    : parameters_(std::move(parameters)), empty_(makeVertexArray()) {
  if (parameters_.size() > 16) throw std::invalid_argument("a stage has at most 16 parameters");
  ShaderSlots slots;
  slots.files["stage"] = file;
  program_ = Program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", slots),
                     assembleShader(library, "sim/camera/glsl/sensor_stage.frag.glsl", slots));
}

void FormulaStage::run(const SensorTick& tick, SensorPictures& pictures) {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(empty_);
  program_.use();
  if (!parameters_.empty()) glUniform1fv(program_.uniform("parameters"), static_cast<GLsizei>(parameters_.size()), parameters_.data());
  glUniform1i(program_.uniform("cellsPerPixel"), pictures.cells);
  glUniform1i(program_.uniform("frameNumber"), tick.frame);
  glUniform2i(program_.uniform("last"), pictures.width - 1, pictures.height - 1);
  for (size_t o = 0; o < pictures.outputs.size(); ++o) {
    pictures.next(o).bind();
    pictures.now(o).bind(0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  checkGl("a stage of a sensor");
  pictures.advance();
}

}  // namespace pitviper
