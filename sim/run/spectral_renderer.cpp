#include "sim/run/spectral_renderer.hpp"

#include <algorithm>
#include <cmath>

#include "sim/frame/make_frame.hpp"
#include "sim/frame/spectral_image.hpp"

namespace pitviper {
namespace {

/// Visibility, depth, four RGBA targets of a pass and their copies [bytes a subpixel], and what all passes that are kept may take.
constexpr double kBytesPerSubpixel = 140.0, kMostKept_bytes = 1e9;

}  // namespace

std::vector<Camera> spectralPasses(const Camera& camera) {
  const SpectralBins& bins = *camera.spectralImage;
  auto width = [&](int bin) { return bins.edge_um[static_cast<size_t>(bin) + 1] - bins.edge_um[static_cast<size_t>(bin)]; };
  Camera pass = camera;
  pass.truth = {};
  pass.sharesShading = false;
  std::vector<Camera> passes;
  for (int first = 0, end = 0; first < bins.count(); first = end) {
    // The bins share their wavelengths (one loop in the shader), by width: the narrowest, first, gets `samples`, no other twice as many.
    pass.outputs.clear();
    for (end = first; end < bins.count() && end - first < kMostSlots && width(end) < 2.0 * width(first); ++end) pass.outputs.push_back(binOutput(bins, end));
    const double total = bins.edge_um[static_cast<size_t>(end)] - bins.edge_um[static_cast<size_t>(first)];
    pass.spectral = {static_cast<int>(std::lround(bins.samples * total / width(first))), Spacing::Gauss, true};
    pass.spectral.reference = camera.spectral.reference;
    passes.push_back(pass);
  }
  return passes;
}

SpectralRenderer::SpectralRenderer(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation), camera_(camera), library_(library), scene_(std::move(scene)), passes_(spectralPasses(camera)) {
  const double subpixels = static_cast<double>(camera.pinhole.width) * camera.pinhole.height * camera.samples * camera.samples;
  const size_t most = static_cast<size_t>(kMostKept_bytes / (kBytesPerSubpixel * subpixels));
  for (size_t p = 0; p < std::min(most, passes_.size()); ++p)
    kept_.push_back(std::make_unique<CameraRenderer>(simulation_, passes_[p], cameraPlan(simulation_, passes_[p]), library_, scene_));
}

Frame SpectralRenderer::render(const WorldState& state, int number) {
  Frame frame = startFrame(camera_, state, number);
  frame.kind = kSpectralKind;
  for (size_t p = 0; p < passes_.size(); ++p)
    addOutputs(frame, passes_[p],
               p < kept_.size() ? kept_[p]->render(state)
                                : CameraRenderer(simulation_, passes_[p], cameraPlan(simulation_, passes_[p]), library_, scene_).render(state));
  Camera whole = camera_;
  whole.outputs.clear();  // the channels are in the frame beside it
  addMetadata(frame, simulation_, whole, state);
  addBins(frame, *camera_.spectralImage);
  return frame;
}

}  // namespace pitviper
