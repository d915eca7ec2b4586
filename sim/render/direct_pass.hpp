#pragma once
// Direct mode: shading integrates straight into the channels; the spectral image never exists. Source: Duvenhage 2006 section 4.6.1.
#include "sim/render/scene_pass.hpp"
#include "sim/render/surface/class_programs.hpp"

namespace pitviper {

class DirectPass final : public ScenePass {
 public:
  DirectPass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
             double apertureArea_m2, bool classes = true);
  std::vector<NamedProgram> programs() const override;
  bool drawsTiles() const override { return true; }

 private:
  bool sharesShading() const override { return true; }
  void shade(RenderTarget& into, const RenderTarget& visibility) override;
  void shadeTile(RenderTarget& into, const glm::ivec4& part, const std::set<std::size_t>& classes) override;
  ClassPrograms programs_;
  Buffer weights_;
};

}  // namespace pitviper
