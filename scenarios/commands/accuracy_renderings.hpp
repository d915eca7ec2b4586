#pragma once
// A scenario's camera drawn at one accuracy and at another, pixel by pixel: what `bench --accuracy` and the tests of the promise compare.
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

/// The scenario with one camera, at a setting.
class Renderings {
 public:
  /// The simulation must outlive it. Needs a current GlContext.
  Renderings(const Simulation& simulation, const Camera& camera, const SpectralSampling& sampling, const std::shared_ptr<const GpuScene>& scene);
  CameraRenderer& renderer() { return *renderer_; }
  const Plan& plan() const { return renderer_->plan(); }
  /// Adds a frame's pixels to those of each output, the ones that `left` marks left out.
  void add(const WorldState& state, const std::vector<char>& left, std::vector<std::vector<double>>& outputs);

 private:
  Camera camera_;
  std::unique_ptr<CameraRenderer> renderer_;
};

/// Marks pixels of a frame, from the top, with the outline of something transparent in the middle of a subpixel: there the reference, which casts
/// rays, and the rasteriser see different things.
std::vector<char> outlinePixels(const Simulation& simulation, const Camera& camera, const WorldState& state);

}  // namespace pitviper
