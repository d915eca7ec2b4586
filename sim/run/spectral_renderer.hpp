#pragma once
// Draws a camera's spectral image: bins are channels with a box response, and a pass holds 16 channels.
#include <memory>

#include "sim/camera/camera_renderer.hpp"
#include "sim/frame/frame.hpp"

namespace pitviper {

/// The camera's passes: the same camera with up to 16 bins each, alike in width, as its outputs. The camera has a spectral image.
std::vector<Camera> spectralPasses(const Camera& camera);

class SpectralRenderer {
 public:
  /// Simulation, camera and library must outlive it. Needs a current GlContext.
  SpectralRenderer(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  Frame render(const WorldState& state, int number);

 private:
  const Simulation& simulation_;
  const Camera& camera_;
  const ShaderLibrary& library_;
  std::shared_ptr<const GpuScene> scene_;
  std::vector<Camera> passes_;
  std::vector<std::unique_ptr<CameraRenderer>> kept_;  ///< one per pass, as far as memory allows
};

}  // namespace pitviper
