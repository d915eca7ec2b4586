#pragma once
// A scenario's camera drawn at one accuracy and at another, pixel by pixel along the same lines: what `audit`, `bench --accuracy` and the tests of the promise
// compare.
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sim/camera/camera_renderer.hpp"

namespace pitviper {

/// One output per channel (its radiance where that is asked for, else its first: relative errors are the same for all of a kernel), no truth, no
/// spectral image.
void keepRadianceAlone(Camera& camera);

/// Of a slot; none where the plan was made without an accuracy.
std::optional<double> predictedError(const Plan& plan, std::size_t slot);

struct ComparedPixel {
  int frame = 0, column = 0, row = 0;  ///< frame: of those compared, from 0; row 0 on top
};

/// The frames of a camera of which all pictures are made, and what they have in common.
struct ComparedFrames {
  std::vector<WorldState> states;
  std::vector<std::vector<Ball>> parts;  ///< bright parts with views of their own, by frame: those of whoever draws first; empty before
};
/// Of the n-th pixel of all frames.
ComparedPixel placeOf(std::size_t n, const Camera& camera);

/// The scenario with one camera, at a setting.
class Renderings {
 public:
  /// The simulation must outlive it. Needs a current GlContext.
  Renderings(const Simulation& simulation, const Camera& camera, const SpectralSampling& sampling, const std::shared_ptr<const GpuScene>& scene);
  CameraRenderer& renderer() { return *renderer_; }
  const Plan& plan() const { return renderer_->plan(); }
  /// Pixels of each output, of all frames. `drawn`: told after each frame.
  std::vector<std::vector<double>> draw(ComparedFrames& frames, const std::function<void()>& drawn = {});

 private:
  Camera camera_;
  std::unique_ptr<CameraRenderer> renderer_;
};

/// The reference, for what a camera draws.
SpectralSampling referenceSampling();

}  // namespace pitviper
