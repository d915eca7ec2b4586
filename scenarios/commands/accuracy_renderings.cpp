#include "scenarios/commands/accuracy_renderings.hpp"

#include <algorithm>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/camera_image.hpp"
#include "sim/render/reference/outline.hpp"

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
      for (size_t p = 0; p < pixels.size(); ++p)
        if (!frames.left[f][p]) outputs[c].push_back(pixels[p]);
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

int ComparedFrames::leftOut() const {
  std::ptrdiff_t n = 0;
  for (const auto& marks : left) n += std::count(marks.begin(), marks.end(), 1);
  return static_cast<int>(n);
}

ComparedPixel ComparedFrames::placeOf(std::size_t n, int width) const {
  for (size_t f = 0; f < left.size(); ++f)
    for (size_t p = 0; p < left[f].size(); ++p)
      if (!left[f][p] && n-- == 0) return {static_cast<int>(f), static_cast<int>(p) % width, static_cast<int>(p) / width};
  return {};
}

ComparedFrames comparedFrames(const Simulation& sim, const Camera& camera, std::vector<WorldState> states) {
  ComparedFrames frames{std::move(states), {}, {}};
  for (const WorldState& state : frames.states) frames.left.push_back(outlinePixels(sim, camera, state));
  return frames;
}

std::vector<char> outlinePixels(const Simulation& sim, const Camera& camera, const WorldState& state) {
  const View view = cameraView(camera, state, camera.samples);
  std::vector<char> drawn(sim.entities.size(), 1);
  if (camera.mount.carrier >= 0) drawn[static_cast<size_t>(camera.mount.carrier)] = 0;
  std::vector<char> marked(static_cast<size_t>(camera.pinhole.width) * static_cast<size_t>(camera.pinhole.height), 0);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      char& mark = marked[static_cast<size_t>((view.height - 1 - y) / camera.samples) * static_cast<size_t>(camera.pinhole.width) +
                          static_cast<size_t>(x / camera.samples)];
      mark = static_cast<char>(mark || onOutline(sim, state, view, drawn, x, y));
    }
  if (!sim.hasTransparent()) return marked;
  // Small bodies are drawn by lines all over a pixel: some of those may lie on an outline.
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    if (!drawn[e] || !state.isThere(e)) continue;
    const glm::dvec3 to = state.entities[e].position + state.entities[e].orientation * glm::dvec3(sim.entities[e].boundingCentre) - view.position;
    const glm::dvec3 d = glm::transpose(view.localFromCamera) * to;
    const double radius_m = static_cast<double>(sim.entities[e].boundingRadius_m), pixel_rad = view.tanPerPixelX * camera.samples;
    if (!(d.z < -radius_m) || 2.0 * radius_m / glm::length(d) > camera.smallBody_px * pixel_rad) continue;
    const glm::dvec2 at = filmPosition(view, d);
    const double reach = radius_m / glm::length(d) / pixel_rad * camera.samples + camera.samples;
    for (int y = std::max(0, static_cast<int>(at.y - reach)); y < std::min<double>(view.height, at.y + reach); ++y)
      for (int x = std::max(0, static_cast<int>(at.x - reach)); x < std::min<double>(view.width, at.x + reach); ++x)
        if (outlineWithin(sim, state, view, drawn, x, y))
          marked[static_cast<size_t>((view.height - 1 - y) / camera.samples) * static_cast<size_t>(camera.pinhole.width) +
                 static_cast<size_t>(x / camera.samples)] = 1;
  }
  return marked;
}

}  // namespace pitviper
