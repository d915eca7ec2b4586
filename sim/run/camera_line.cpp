#include "sim/run/camera_line.hpp"

#include <algorithm>

#include "sim/frame/make_frame.hpp"
#include "sim/frame/pointing_header.hpp"
#include "sim/gl/timing.hpp"

namespace pitviper {

CameraLine::CameraLine(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
                       const std::function<void(double)>& planning, bool allRungs, bool isDraft)
    : simulation_(simulation), camera_(camera), isDraft_(isDraft) {
  std::vector<double> accuracies = rungsOf(camera);
  if (!allRungs) accuracies.resize(1);
  if (isDraft) accuracies = {kDraft};
  drawing_ = std::make_unique<CameraDrawing>(simulation, camera, library, scene, accuracies, planning);
  makeSensor(library);
}

CameraLine::CameraLine(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::unique_ptr<CameraDrawing> drawing, bool isDraft)
    : simulation_(simulation), camera_(camera), drawing_(std::move(drawing)), isDraft_(isDraft) {
  makeSensor(library);
}

void CameraLine::makeSensor(const ShaderLibrary& library) {
  if (camera_.hasStages()) chain_ = std::make_unique<SensorChain>(camera_, library);
  if (camera_.truth.targets || camera_.truth.terms) truth_ = std::make_unique<TruthMeter>(simulation_, camera_);
  if (camera_.follower) pointer_ = std::make_unique<CameraPointer>(simulation_, camera_);
}

void CameraLine::startAgain(int first, const ShaderLibrary& library, const StateAt& stateAt) {
  makeSensor(library);
  warmUp(first, stateAt);
}

void CameraLine::takeOver(std::unique_ptr<CameraDrawing> drawing) {
  drawing_ = std::move(drawing);
  rung_ = 0;
  isDraft_ = false;
}

void CameraLine::warmUp(int first, const StateAt& others) {
  const TimedPart part("frames before the first");
  const StateAt scenarios = others ? others : [this](double t) { return advance(simulation_, t); };
  const int frames = warmUpOf(camera_, simulation_.time.step_s);
  for (int number = (looksAtItsPictures() ? 0 : first) - frames; number < first; ++number) {
    const double time_s = simulation_.time.at(number);
    // Before its first tick it stands where it starts.
    const bool ticks = !pointer_ || (number >= 0 && pointer_->remembers());
    if (!ticks) pointer_->tickTo(scenarios, pointer_->remembers() ? 0 : std::max(first, 0));
    begin(ticks ? scenarios : pointer_->around(scenarios), time_s, ticks ? std::optional(number) : std::nullopt);
    const CameraImage image = finish();
    if (looksAtItsPictures()) seen(image, stateAt_(time_s), number, {}, {});
    else sensed(simulation_, camera_, image, stateAt_(time_s), number, *chain_);
  }
}

void CameraLine::prepare(const StateAt& stateAt, double time_s) {
  const std::size_t before = rung_;
  for (rung_ = 0; rung_ < rungs(); ++rung_) {
    begin(stateAt, time_s);
    finish();
  }
  rung_ = before;
}

void CameraLine::begin(const StateAt& stateAt, double time_s, std::optional<int> number) {
  stateAt_ = stateAt;
  isPointed_ = pointer_ && number;
  if (isPointed_) {
    pointer_->tickTo(stateAt, *number);
    stateAt_ = pointer_->around(stateAt);
  }
  time_s_ = time_s;
  parts_ = exposureParts(simulation_, camera_, stateAt_, time_s);
  const UsedContext used(drawing_->context());
  if (parts_.times_s.size() == 1) renderer().begin(stateAt_(parts_.times_s[0]));
}

CameraImage CameraLine::finish(std::optional<int> audited, bool isFirst) {
  const auto look = [&](const WorldState& then, CameraImage& drawn) {
    const TimedPart part("audit");
    auditor().look(then, *audited, drawn, isFirst);
  };
  const UsedContext used(drawing_->context());
  CameraImage image;
  if (parts_.times_s.size() > 1) {
    image = renderParts(renderer(), parts_, stateAt_, audited ? look : std::function<void(const WorldState&, CameraImage&)>());
  } else {
    image = renderer().finish();
    if (audited) look(stateAt_(parts_.times_s[0]), image);
  }
  if (isPointed_) image.pointing = pointer_->pointing();
  image.isDraft = isDraft_;
  return image;
}

Frame CameraLine::seen(const CameraImage& image, const WorldState& state, int number, std::vector<TargetRow> targets, std::vector<FrameLayer> terms) {
  std::optional<TimedPart> part("frame");
  Frame frame = makeFrame(simulation_, camera_, image, state, number, chain_.get(), std::move(targets), std::move(terms));
  if (!image.pointing) return frame;
  CameraPointing pointing = *image.pointing;
  if (looksAtItsPictures()) {
    part.emplace("centroid");
    pointing.tracked = pointer_->look(frame.layers[*camera_.follower->output].pixels);
  }
  addPointing(frame, pointing);
  return frame;
}

Frame CameraLine::frame(const CameraImage& image, const WorldState& world, int number, const StateAt& others) {
  const WorldState state = image.pointing ? pointed(world, camera_, image.pointing->followed.pose) : world;
  std::vector<TargetRow> targets;
  std::vector<FrameLayer> terms;
  if (truth_) {
    const TimedPart part("truth");
    const StateAt scenarios = [this](double t) { return advance(simulation_, t); };
    if (camera_.truth.targets) targets = truth_->targets(state, image.pointing ? pointer_->around(others ? others : scenarios) : others);
    if (camera_.truth.terms) terms = truth_->terms(state);
  }
  return seen(image, state, number, std::move(targets), std::move(terms));
}

}  // namespace pitviper
