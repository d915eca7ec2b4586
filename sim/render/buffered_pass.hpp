#pragma once
// Buffered mode: the target holds the spectral image, one value per spectral node, and a pass of its own integrates it with the
// channels' kernels; between the two, transparent things are blended over it. Source: Duvenhage 2006 sections 4.6.2 and 5.3. Nodes beyond 32
// (eight RGBA targets) go in further batches, whose integrals add up.
#include "sim/render/media/seen_through.hpp"
#include "sim/render/scene_pass.hpp"
#include "sim/render/surface/class_programs.hpp"

namespace pitviper {

class BufferedPass final : public ScenePass {
 public:
  BufferedPass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
               double apertureArea_m2, bool classes = true);
  std::vector<NamedProgram> programs() const override;

 private:
  void shade(RenderTarget& into, const RenderTarget& visibility) override;
  void onTemperatures() override;
  void place(const View& view, const WorldState& state, const std::vector<char>& drawn, std::vector<GpuDraw>& draws) override;
  bool sharesShading() const override { return true; }
  bool drawsOver() const { return transparent_ && !transparent_->isEmpty(); }
  const RenderTarget* withoutTransparent() const override { return drawsOver() ? &*before_ : nullptr; }
  bool transparentIsAveraged() const override { return drawsOver() && transparent_->isOfFields(); }
  void leaveOut(RenderTarget& visibility) override;
  struct Batch {
    int firstNode = 0;
    Program integrate;
    Buffer weights;
  };
  void integrate(const Batch& batch, RenderTarget& into, const RenderTarget& spectrum, bool adds) const;
  RenderTarget& spectrumFor(const RenderTarget& visibility);

  std::vector<Batch> batches_;
  ClassPrograms shade_;
  ShadingProgram truth_;
  std::unique_ptr<SeenThrough> transparent_;  ///< null: nothing in the scenario is
  int targets_ = 0;                           ///< RGBA targets of the spectral image
  std::deque<RenderTarget> spectra_;
  bool warm_ = false, covers_ = false;  ///< what is transparent has drawn; pixels have been left out
  std::optional<RenderTarget> before_;  ///< channels of whole pixels
};

}  // namespace pitviper
