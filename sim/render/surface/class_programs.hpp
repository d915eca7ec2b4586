#pragma once
// The shading of a picture: a program for each class of surfaces, each over its own pixels.
#include <functional>
#include <set>

#include "sim/render/assembly/named_program.hpp"
#include "sim/render/surface/shading_program.hpp"
#include "sim/render/surface/surface_classes.hpp"

namespace pitviper {

class ClassPrograms {
 public:
  ClassPrograms() = default;
  /// `slots`: of a program for all solid surfaces; `targets`: as ShadingProgram's, from the first colour on.
  ClassPrograms(const ShaderLibrary& library, const ShaderSlots& slots, const RenderTables& tables, const std::vector<SurfaceClass>& classes,
                const std::vector<std::string>& targets);
  /// Of some classes. `set`: sets uniforms of each.
  void run(RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes,
           const std::function<void(const ShadingProgram&)>& set = {}) const;
  /// Adds those that run() would draw to what is made together.
  void addTo(FirstDraws& first, RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes) const;
  /// Over a part of the picture (corner, size).
  void run(RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes, const glm::ivec4& part) const;
  void addTo(std::vector<NamedProgram>& all) const;

 private:
  void makeThose(RenderTarget& into, const PixelClasses& pixels, const std::set<std::size_t>& classes) const;
  std::vector<ShadingProgram> programs_;  ///< of each class
};

}  // namespace pitviper
