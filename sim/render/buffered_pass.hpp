#pragma once
// Buffered mode: the target holds the spectral image, one value per spectral node, and a pass of its own integrates it with the
// channels' kernels. Source: Duvenhage 2006 section 4.6.2. Nodes beyond 32 (eight RGBA targets) go in further batches, whose integrals add up.
#include "sim/render/scene_pass.hpp"

namespace pitviper {

class BufferedPass final : public ScenePass {
 public:
  BufferedPass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
               double apertureArea_m2);

 private:
  void shade(RenderTarget& into) override;
  RenderTarget& spectrumFor(int width, int height);

  struct Batch {
    int firstNode = 0;
    Program integrate;
    Buffer weights;
  };
  std::vector<Batch> batches_;
  Program shade_, truth_;
  int targets_ = 0;  ///< RGBA targets of the spectral image
  std::deque<RenderTarget> spectra_;
};

}  // namespace pitviper
