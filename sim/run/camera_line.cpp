#include "sim/run/camera_line.hpp"

#include <algorithm>

#include "sim/frame/make_frame.hpp"
#include "sim/gl/timing.hpp"

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

CameraLine::CameraLine(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
                       const std::function<void(double)>& planning, bool allRungs)
    : simulation_(simulation), camera_(camera) {
  const std::vector<double> accuracies = rungsOf(camera);
  for (std::size_t k = 0; k < (allRungs ? accuracies.size() : 1); ++k) {
    auto drawn = std::make_unique<Camera>(drawnCamera(k == 0 ? camera : withAccuracy(camera, accuracies[k])));
    if (k > 0) drawn->plan.clear();  // one that was given is of the accuracy asked for
    auto renderer = std::make_unique<CameraRenderer>(simulation, *drawn, library, scene, planning);
    rungs_.push_back({std::move(drawn), std::move(renderer)});
  }
  auditor_ = std::make_unique<Auditor>(simulation, *rungs_[0].drawn, rungs_[0].renderer->plan(), library, scene);
  if (!camera.stages.empty()) chain_ = std::make_unique<SensorChain>(camera, library);
  if (camera.truth.targets || camera.truth.terms) truth_ = std::make_unique<TruthMeter>(simulation, camera);
}

void CameraLine::warmUp(int first) {
  const TimedPart part("frames before the first");
  const auto scenarios = [this](double t) { return advance(simulation_, t); };
  for (int number = first - warmUpOf(camera_, simulation_.time.step_s); number < first; ++number) {
    const double time_s = simulation_.time.at(number);
    begin(scenarios, time_s);
    sensed(simulation_, camera_, finish(), scenarios(time_s), number, *chain_);
  }
}

void CameraLine::prepare(const StateAt& stateAt, double time_s) {
  const std::size_t before = rung_;
  for (rung_ = 0; rung_ < rungs_.size(); ++rung_) {
    begin(stateAt, time_s);
    finish();
  }
  rung_ = before;
}

void CameraLine::begin(const StateAt& stateAt, double time_s) {
  stateAt_ = stateAt;
  time_s_ = time_s;
  parts_ = exposureParts(simulation_, camera_, stateAt, time_s);
  if (parts_.times_s.size() == 1) renderer().begin(stateAt(parts_.times_s[0]));
}

CameraImage CameraLine::finish(std::optional<int> audited, bool isFirst) {
  const auto look = [&](const WorldState& then, CameraImage& drawn) {
    const TimedPart part("audit");
    auditor_->look(then, *audited, drawn, isFirst);
  };
  if (parts_.times_s.size() > 1) return renderParts(renderer(), parts_, stateAt_, audited ? look : std::function<void(const WorldState&, CameraImage&)>());
  CameraImage image = renderer().finish();
  if (audited) look(stateAt_(parts_.times_s[0]), image);
  return image;
}

Frame CameraLine::frame(const CameraImage& image, const WorldState& state, int number, const StateAt& stateAt) {
  std::vector<TargetRow> targets;
  std::vector<FrameLayer> terms;
  if (truth_) {
    const TimedPart part("truth");
    if (camera_.truth.targets) targets = truth_->targets(state, stateAt);
    if (camera_.truth.terms) terms = truth_->terms(state);
  }
  const TimedPart part("frame");
  return makeFrame(simulation_, camera_, image, state, number, chain_.get(), std::move(targets), std::move(terms));
}

}  // namespace pitviper
