#pragma once
// Spectral shading of every pixel of a picture, as full-screen fragments or as compute, from the same bodies.
#include "sim/gl/first_draws.hpp"
#include "sim/render/geometry/pixel_classes.hpp"

namespace pitviper {

enum class ShadingStage { Fragment, Compute };

/// Fragments where the CPU draws (compute takes as long on a wall, `bench --factor shading`, but more than five times as long for a frame of first_light, whose
/// surfaces have classes), compute on a GPU (data-centre GPUs give fragments few of their units); the environment variable PITVIPER_SHADING (fragment, compute)
/// overrides. Throws GlError for another word.
ShadingStage chooseShadingStage();
std::string nameOf(ShadingStage stage);

class ShadingProgram {
 public:
  ShadingProgram() = default;
  /// `targets`: names of the vec4 that the slots' text fills, in the order of the target's colours from `firstColour` on.
  ShadingProgram(const ShaderLibrary& library, ShaderSlots slots, const std::vector<std::string>& targets, std::size_t firstColour);
  /// The stage that shades, as it was compiled.
  const std::string& text() const { return program_.text(); }
  /// Uniforms may be set between use() and run().
  void use() const { program_.use(); }
  int uniform(const char* name) const { return program_.uniform(name); }
  /// Adds it to what is made together, as run() will draw it: buffers and textures are bound.
  void addTo(FirstDraws& draws, RenderTarget& into, const ChosenPixels& chosen) const;
  /// Buffers and textures are bound; binds and selects its colours of the target, whose depth becomes the classes'. `part`: corner and size; of size 0: all.
  void run(RenderTarget& into, const ChosenPixels& chosen, const glm::ivec4& part = glm::ivec4(0)) const;

 private:
  void bind(RenderTarget& into, const ChosenPixels& chosen, const glm::ivec4& part) const;
  ShadingStage stage_ = ShadingStage::Fragment;
  std::size_t firstColour_ = 0, colours_ = 0;
  Program program_;
};

}  // namespace pitviper
