#pragma once
// Direct mode: a visibility pass (which triangle each pixel sees), then spectral shading once per visible pixel, straight into
// the channels. Speed does not depend on how much is hidden.
#include <deque>
#include <memory>

#include "sim/render/gpu_scene.hpp"
#include "sim/render/tables.hpp"
#include "sim/render/view.hpp"

namespace pitviper {

/// Integrals of kernel x radiance per subpixel, as read back. Row 0 is the bottom.
struct RawImage {
  int width = 0, height = 0;
  std::vector<std::vector<float>> groups;  ///< four slots each, RGBA
  std::vector<std::vector<float>> truth;   ///< three layers of RGBA where asked for
  std::vector<float> depth;                ///< reversed: near / z; 0 where nothing was met. Empty unless asked for
  std::vector<int> entity;                 ///< what each pixel sees, -1 the background. Empty unless asked for
};

class DirectPass {
 public:
  DirectPass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene,
             bool truth, double apertureArea_m2);

  /// Uploads what changes with time: light levels.
  void setState(const WorldState& state);
  /// `drawn`: one flag per entity; the others are left out (small bodies have views of their own).
  void draw(const View& view, const WorldState& state, const std::vector<char>& drawn);
  /// Starts copying the last drawn image.
  void startReadback(bool depth, bool identity = false);
  RawImage finishReadback();
  const AssembledShader& fragmentSource() const { return fragmentSource_; }

 private:
  void uploadView(const View& view);
  void uploadDraws(const View& view, const WorldState& state);

  const Simulation& simulation_;
  const Plan& plan_;
  std::shared_ptr<const GpuScene> scene_;
  bool truth_;
  double apertureArea_m2_;
  RenderTables tables_;
  AssembledShader fragmentSource_;
  Program visibility_, shade_;
  Buffer rows_, hemispherical_, columns_, materials_, nodes_, weights_, draws_, lights_, view_;
  struct Targets {
    RenderTarget visibility, shading;
  };
  Targets& targetsFor(int width, int height);
  std::deque<std::pair<std::pair<int, int>, Targets>> targets_;  // references stay valid
  Targets* current_ = nullptr;
  Readback readback_;
};

}  // namespace pitviper
