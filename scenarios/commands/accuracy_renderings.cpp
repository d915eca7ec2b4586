#include "scenarios/commands/accuracy_renderings.hpp"

#include <algorithm>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/camera_image.hpp"

namespace pitviper {

void keepRadianceAlone(Camera& camera) {
  std::vector<ChannelOutput> chosen;
  for (const ChannelOutput& output : camera.outputs) {
    auto same = std::find_if(chosen.begin(), chosen.end(), [&](const ChannelOutput& c) { return c.channel == output.channel; });
    if (same == chosen.end()) chosen.push_back(output);
    else if (output.quantity == "radiance") *same = output;
  }
  camera.outputs = std::move(chosen);
  camera.truth = {};
  camera.spectralImage.reset();
}

std::optional<double> predictedError(const Plan& plan, std::size_t slot) {
  if (slot < plan.predictedError.size()) return plan.predictedError[slot];
  return {};
}

Renderings::Renderings(const Simulation& sim, const Camera& camera, const SpectralSampling& sampling, const std::shared_ptr<const GpuScene>& scene)
    : camera_(camera) {
  camera_.spectral = sampling;
  renderer_ = std::make_unique<CameraRenderer>(sim, camera_, cameraPlan(sim, camera_), shaderLibrary(), scene);
}

std::vector<std::vector<double>> Renderings::draw(ComparedFrames& frames, const std::function<void()>& drawn) {
  std::vector<std::vector<double>> outputs(camera_.outputs.size());
  const bool first = frames.parts.empty();
  for (size_t f = 0; f < frames.states.size(); ++f) {
    if (!first) renderer_->setParts(frames.parts[f]);
    CameraImage image = renderer_->render(frames.states[f]);
    if (first) frames.parts.push_back(image.parts);
    putPointsIntoPixels(image);
    for (size_t c = 0; c < outputs.size(); ++c) {
      const auto& pixels = image.slots[static_cast<size_t>(image.slotOfOutput[c])];
      outputs[c].insert(outputs[c].end(), pixels.begin(), pixels.end());
    }
    if (drawn) drawn();
  }
  return outputs;
}

SpectralSampling referenceSampling() {
  SpectralSampling s;
  s.reference = true;
  return s;
}

ComparedPixel placeOf(std::size_t n, const Camera& camera) {
  const auto width = static_cast<std::size_t>(camera.pinhole.width), pixels = width * static_cast<std::size_t>(camera.pinhole.height);
  return {static_cast<int>(n / pixels), static_cast<int>(n % width), static_cast<int>(n % pixels / width)};
}

}  // namespace pitviper
