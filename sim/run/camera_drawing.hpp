#pragma once
// What draws a camera: a renderer for each rung of accuracy, and what audits the first of them.
#include <functional>
#include <memory>
#include <vector>

#include "sim/camera/audit.hpp"
#include "sim/gl/context.hpp"

namespace pitviper {

/// A camera drawn to another accuracy.
Camera withAccuracy(const Camera& camera, double accuracy);
/// What a stream of a camera may be drawn to: the accuracy asked for, then twice that and so on up to SpectralSampling::atMost. One at least.
std::vector<double> rungsOf(const Camera& camera);

/// What a draft is drawn to: few groups, and few lines of sight to find them by (sim/plan/plan_effort.hpp).
inline constexpr double kDraft = 0.2;
/// Whether a draft of a camera's pictures is there sooner: where its plan has an accuracy to hold, and is neither given nor known.
bool hasDraft(const Simulation& simulation, const Camera& camera);

class CameraDrawing {
 public:
  struct Rung {
    std::unique_ptr<Camera> drawn;  ///< which the renderer looks at
    std::unique_ptr<CameraRenderer> renderer;
  };
  /// To each of some accuracies; the first three must outlive it. `planning`: told while plans are made. Needs a current GlContext, which all of it is of: the
  /// thread's that draws, or `own`, which goes after it.
  CameraDrawing(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
                const std::vector<double>& accuracies, const std::function<void(double share)>& planning, std::shared_ptr<const GlContext> own = {});
  /// To the accuracy of a plan at hand, which is one of this camera in a scene of the same materials, lights, bodies and air by number.
  CameraDrawing(const Simulation& simulation, const Camera& camera, Plan plan, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene);
  ~CameraDrawing();
  CameraDrawing(const CameraDrawing&) = delete;
  CameraDrawing& operator=(const CameraDrawing&) = delete;

  CameraRenderer& renderer(std::size_t rung) { return *rungs_[rung].renderer; }
  Auditor& auditor() { return *auditor_; }
  std::size_t rungs() const { return rungs_.size(); }
  double accuracyOf(std::size_t rung) const { return rungs_[rung].drawn->spectral.accuracy; }
  /// Null: the drawing thread's.
  const GlContext* context() const { return own_.get(); }

 private:
  std::shared_ptr<const GlContext> own_;
  std::vector<Rung> rungs_;
  std::unique_ptr<Auditor> auditor_;
};

}  // namespace pitviper
