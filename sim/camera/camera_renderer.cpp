#include "sim/camera/camera_renderer.hpp"

#include "sim/camera/small_bodies.hpp"
#include "sim/camera/stars_in_view.hpp"
#include "sim/camera/sun_in_view.hpp"
#include "sim/camera/visible_lights.hpp"
#include "sim/camera/zoomed_lines.hpp"
#include "sim/gl/timing.hpp"
#include "sim/plan/freed_memory.hpp"
#include "sim/plan/plan_origin.hpp"
#include "sim/plan/planner.hpp"
#include "sim/world/field_lines.hpp"
#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

/// From so many subpixels on, programs of its own for each class of surfaces are worth the tenths of a second that a driver takes to compile them.
constexpr int kWorthClasses = 64 * 64;
/// What the reference asks of bright parts where no accuracy is.
constexpr double kReferenceParts = 0.002;

/// A reference that was given a plan looks along the lines that pictures by that plan look along.
Plan planOfLines(const Simulation& simulation, const Camera& camera) {
  const Camera planned = plannedCamera(camera);
  return planFor(simulation, {&planned, nullptr});
}

}  // namespace

Plan cameraPlan(const Simulation& simulation, const Camera& camera, const std::function<void(double)>& planning, const Plan* earlier) {
  const TimedPart part(kPlanningPart);
  Plan plan = planFor(simulation, {&camera, nullptr}, planning, Foretold::IfChosen, earlier);
  giveBackFreedMemory();
  return plan;
}

CameraRenderer::CameraRenderer(const Simulation& simulation, const Camera& camera, Plan plan, const ShaderLibrary& library,
                               std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation),
      camera_(camera),
      plan_(std::move(plan)),
      fringes_(averagedFringes(simulation, camera.outputs)),
      ways_(simulation, plan_),
      lines_(zoomedLines(simulation, camera.zoomedSamples, camera.outlineAccuracy)),
      areas_m2_(facingAreas(simulation)),
      linesOf_(camera.spectral.reference && !camera.plan.empty() ? std::make_unique<const Plan>(planOfLines(simulation, camera)) : nullptr),
      hotParts_(simulation, linesOf_ ? *linesOf_ : plan_,
                camera.outlineAccuracy > 0.0             ? camera.outlineAccuracy
                : camera.spectral.reference && !linesOf_ ? kReferenceParts
                                                         : 0.0) {
  const bool truth = camera.truth.any(), transparent = simulation.hasTransparent();
  const double area_m2 = camera.pinhole.apertureArea_m2();
  if (camera.spectral.reference) {
    reference_ = std::make_unique<ReferenceDrawer>(simulation, plan_, library, scene, truth, area_m2);
    drawer_ = reference_.get();
    return;
  }
  const bool classes = camera.pinhole.width * camera.samples * camera.pinhole.height * camera.samples >= kWorthClasses;
  if (simulation.mode == RenderMode::Buffered || transparent)
    buffered_ = std::make_unique<BufferedPass>(simulation, plan_, library, scene, truth, area_m2, classes);
  // Its program is made at the start even where the first frame needs the other: none may be late for want of a compiler.
  if (simulation.mode != RenderMode::Buffered) direct_ = std::make_unique<DirectPass>(simulation, plan_, library, scene, truth, area_m2, classes);
  if (direct_ && buffered_) direct_->shareLight(*buffered_);
  drawer_ = buffered_ ? static_cast<LineDrawer*>(buffered_.get()) : direct_.get();
}

bool CameraRenderer::seesTransparent() const {
  for (size_t f = 0; f < simulation_.fields.size(); ++f)
    if (const FieldState* field = fieldOf(state_, f); field && !fieldLines(view_, *field).isEmpty()) return true;
  for (size_t e = 0; e < present_.size(); ++e) {
    const Entity& entity = simulation_.entities[e];
    if (!present_[e] || !simulation_.isTransparent(entity)) continue;
    const Pose& pose = state_.entities[e];
    if (mayShow(view_, pose.position + pose.orientation * glm::dvec3(entity.boundingCentre), entity.boundingRadius_m)) return true;
  }
  return false;
}

void CameraRenderer::setProgress(std::function<void(double)> progress) {
  if (reference_) reference_->setProgress(std::move(progress));
}

/// The camera's own and those of its small bodies.
int CameraRenderer::viewsOfPicture() const {
  int views = 1 + static_cast<int>(parts_.size());
  for (size_t e = 0; e < small_.size(); ++e) {
    const Pose& pose = state_.entities[e];
    const Entity& entity = simulation_.entities[e];
    if (small_[e] && present_[e] && mayShow(view_, pose.position + pose.orientation * glm::dvec3(entity.boundingCentre), entity.boundingRadius_m)) ++views;
  }
  return views;
}

void CameraRenderer::takeAir(CameraRenderer& before) {
  if (direct_ && before.direct_) direct_->takeAir(*before.direct_);
  if (buffered_ && before.buffered_) buffered_->takeAir(*before.buffered_);
}

void CameraRenderer::begin(const WorldState& state) {
  state_ = state;
  view_ = cameraView(camera_, state, camera_.samples);
  view_.wanted = wanted_;
  view_.grouped = camera_.sharesShading ? camera_.samples : 1;
  view_.subpixels = camera_.samples;
  if (const Pinhole now = cameraAt(camera_, state).pinhole; now.focalLength_m != focalLength_m_) {
    solidAngles_ = std::make_shared<const Pinhole::SolidAngles>(now.solidAngles());
    focalLength_m_ = now.focalLength_m;
  }
  // The carrier would be seen from inside: a camera does not see the body it rides on.
  present_.assign(simulation_.entities.size(), 1);
  for (size_t e = 0; e < present_.size(); ++e) present_[e] = state.isThere(e);
  if (camera_.mount.carrier >= 0) present_[static_cast<size_t>(camera_.mount.carrier)] = 0;
  small_ = findSmallBodies(simulation_, state_, view_, camera_.smallBody_px * camera_.samples);
  parts_ = given_ ? *given_ : hotParts_.inView(state_, view_, camera_.smallBody_px * camera_.samples, small_, present_);
  view_.kept = smallBodiesIn(simulation_, state_, view_, small_, present_, parts_);
  std::vector<char> drawn(present_);
  for (size_t e = 0; e < drawn.size(); ++e) drawn[e] = present_[e] && !small_[e];
  overlay_.reset();
  if (direct_ && buffered_) {
    drawer_ = seesTransparent() ? static_cast<LineDrawer*>(buffered_.get()) : direct_.get();
    if (isBuffered()) overlay_ = overlayIn(simulation_, state_, view_, drawn);
  }
  if (reference_) reference_->beginPicture(viewsOfPicture());
  std::vector<double> zoomed(present_.size(), 0.0);
  for (size_t e = 0; e < zoomed.size(); ++e) zoomed[e] = small_[e] ? zoomedLinesOn(e) : 0.0;
  const ShadowDemand demand{view_, present_, zoomed};
  warmUp(demand, drawn);
  drawer_->setState(state_, &demand);
  if (!overlay_) {
    drawer_->draw(view_, state_, drawn);
    drawer_->startReadback();
    return;
  }
  direct_->setState(state_, &demand);
  direct_->draw(view_, state_, drawn);
  direct_->startReadback();
  if (overlay_->isEmpty()) return;
  buffered_->draw(overlayView(view_, *overlay_), state_, drawn);
  buffered_->startReadback();
}

/// Of a small body's own view, those that see it.
double CameraRenderer::zoomedLinesOn(std::size_t entity) const {
  const Ball ball = ballOf(simulation_, state_, static_cast<int>(entity));
  const glm::dvec3 direction = glm::normalize(glm::conjugate(state_.entities[entity].orientation) * (ball.centre - view_.position));
  return zoomedFill(glm::length(direction * areas_m2_[entity]), ball.radius_m) * lines_[entity] * lines_[entity];
}

/// A driver compiles what is left of a program when it is first used: of a moving scene no later frame, in which something transparent comes into view or
/// leaves it, is to wait for that.
void CameraRenderer::warmUp(const ShadowDemand& demand, const std::vector<char>& drawn) {
  if (reference_ || warm_ || !simulation_.drawsMore()) return;
  warm_ = true;
  const TimedPart part("preparing");
  FirstDraws first;
  for (ScenePass* pass : {static_cast<ScenePass*>(direct_.get()), static_cast<ScenePass*>(buffered_.get())}) {
    if (!pass) continue;
    pass->setState(state_, &demand);
    pass->rehearse(view_, state_, drawn, first);
  }
  first.make();
  if (!direct_ || !buffered_) return;
  ScenePass& other = drawer_ == buffered_.get() ? static_cast<ScenePass&>(*direct_) : *buffered_;
  other.setState(state_, &demand);
  other.draw(view_, state_, drawn);
}

void CameraRenderer::setWanted(const std::vector<int>& pixels) {
  const auto n = static_cast<size_t>(camera_.samples), width = static_cast<size_t>(camera_.pinhole.width), height = static_cast<size_t>(camera_.pinhole.height);
  auto flags = std::make_shared<std::vector<char>>(width * n * height * n, 0);
  for (int pixel : pixels) {
    const size_t column = static_cast<size_t>(pixel) % width, row = static_cast<size_t>(pixel) / width;
    for (size_t y = 0; y < n; ++y)
      for (size_t x = 0; x < n; ++x) (*flags)[((height - 1 - row) * n + y) * width * n + column * n + x] = 1;
  }
  wanted_ = std::move(flags);
}

void CameraRenderer::setOnly(const std::optional<Part>& only) {
  only_ = only;
  if (reference_) reference_->setOnly(only);
}

void CameraRenderer::watchParts() {
  if (reference_) reference_->watchParts();
}

std::set<Part> CameraRenderer::parts() const {
  std::set<Part> all = reference_ ? reference_->met() : std::set<Part>{};
  for (size_t l = 0; l < simulation_.lights.size(); ++l)
    if (lightIsInView(simulation_, state_, view_, l)) all.insert({TermKind::LampsInView, -1, static_cast<int>(l)});
  return all;
}

/// Of a part alone: only its own lamp shines into the camera, or none.
WorldState CameraRenderer::lampsInView() const {
  WorldState state = state_;
  for (size_t l = 0; only_ && l < state.lightLevels.size(); ++l)
    if (*only_ != Part{TermKind::LampsInView, -1, static_cast<int>(l)}) state.lightLevels[l] = 0.0;
  return state;
}

CameraImage CameraRenderer::finish() {
  RawImage picture = (overlay_ ? static_cast<LineDrawer*>(direct_.get()) : drawer_)->finishReadback();
  if (overlay_ && !overlay_->isEmpty()) lay(buffered_->finishReadback(), view_, *overlay_, picture);
  Subpixels image(plan_, view_, std::move(picture));
  if (camera_.pointsApart) image.keepPoints();
  {
    const TimedPart part("small bodies");
    const TruthAt truthAt = [this](const WorldState& state, const glm::dvec2& place) {
      return truthSeen(simulation_, state, view_, place, present_, camera_.pinhole.apertureArea_m2(), plan_.textureAccuracy, plan_.terms.lights);
    };
    addSmallBodies(image, *drawer_, simulation_, state_, small_, present_, lines_, parts_, wanted_.get(), image.hasTruth() ? truthAt : TruthAt{});
  }
  {
    const TimedPart part("lamps in view");
    addVisibleLights(image, ways_, simulation_, plan_, lampsInView(), present_);
    if (!only_) {
      addSunInView(image, ways_, simulation_, plan_, state_, present_);
      addStarsInView(image, ways_, simulation_, plan_, state_, present_);
    }
  }
  const TimedPart part("resolve");
  if (reference_) reference_->endPicture();
  CameraImage resolved = image.resolve(camera_.pinhole, camera_.samples, filmWeights_);
  resolved.slotOfOutput = plan_.slotOfOutput;
  resolved.solidAngles = solidAngles_;
  resolved.exposures_s = cameraAt(camera_, state_).exposures_s;
  resolved.exposure_s = longestExposure_s(camera_, resolved.exposures_s);
  resolved.averagedFringes = fringes_;
  resolved.accuracy = plan_.accuracy;
  resolved.predictedError = plan_.predictedError;
  resolved.plan = plan_.fingerprint;
  resolved.parts = parts_;
  return resolved;
}

}  // namespace pitviper
