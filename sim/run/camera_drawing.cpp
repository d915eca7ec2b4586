#include "sim/run/camera_drawing.hpp"

#include <algorithm>

#include "sim/plan/planner.hpp"

namespace pitviper {

Camera withAccuracy(const Camera& camera, double accuracy) {
  Camera other = camera;
  const bool asked = camera.spectral.accuracy > 0.0 && !camera.spectral.reference;
  if (!asked) return other;
  other.spectral.accuracy = accuracy;
  other.outlineAccuracy = camera.outlineAccuracy > 0.0 ? accuracy : 0.0;
  other.textureAccuracy = camera.textureAccuracy > 0.0 ? accuracy : 0.0;
  return other;
}

std::vector<double> rungsOf(const Camera& camera) {
  const SpectralSampling& s = camera.spectral;
  std::vector<double> all{s.accuracy};
  if (!(s.accuracy > 0.0) || s.reference) return all;
  while (all.back() < s.atMost * (1.0 - 1e-9)) all.push_back(std::min(2.0 * all.back(), s.atMost));
  return all;
}

bool hasDraft(const Simulation& simulation, const Camera& camera) {
  const SpectralSampling& s = camera.spectral;
  return s.accuracy > 0.0 && s.accuracy < kDraft && !s.reference && camera.plan.empty() && !isPlanKnown(simulation, drawnCamera(camera));
}

CameraDrawing::CameraDrawing(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
                             const std::vector<double>& accuracies, const std::function<void(double)>& planning, std::shared_ptr<const GlContext> own)
    : own_(std::move(own)) {
  for (const double accuracy : accuracies) {
    const bool isAsked = accuracy == camera.spectral.accuracy;
    auto drawn = std::make_unique<Camera>(drawnCamera(isAsked ? camera : withAccuracy(camera, accuracy)));
    if (!isAsked) drawn->plan.clear();  // one that was given is of the accuracy asked for
    auto renderer = std::make_unique<CameraRenderer>(simulation, *drawn, cameraPlan(simulation, *drawn, planning), library, scene);
    rungs_.push_back({std::move(drawn), std::move(renderer)});
  }
  auditor_ = std::make_unique<Auditor>(simulation, *rungs_[0].drawn, rungs_[0].renderer->plan(), library, scene);
}

CameraDrawing::CameraDrawing(const Simulation& simulation, const Camera& camera, Plan plan, const ShaderLibrary& library,
                             const std::shared_ptr<const GpuScene>& scene) {
  auto drawn = std::make_unique<Camera>(drawnCamera(camera));
  auto renderer = std::make_unique<CameraRenderer>(simulation, *drawn, std::move(plan), library, scene);
  rungs_.push_back({std::move(drawn), std::move(renderer)});
  auditor_ = std::make_unique<Auditor>(simulation, *rungs_[0].drawn, rungs_[0].renderer->plan(), library, scene);
}

CameraDrawing::~CameraDrawing() {
  const UsedContext used(own_.get());
  auditor_.reset();
  rungs_.clear();
}

}  // namespace pitviper
