#include "sim/render/camera_renderer.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gl/context.hpp"
#include "sim/render/small_bodies.hpp"
#include "sim/render/visible_lights.hpp"

namespace pitviper {

CameraRenderer::CameraRenderer(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation), camera_(camera), plan_(makePlan(simulation, camera.outputs, camera.spectral, camera.where)),
      pass_(simulation, plan_, library, std::move(scene), camera.truth.any(), camera.pinhole.apertureArea_m2()),
      solidAngles_(std::make_shared<const Pinhole::SolidAngles>(camera.pinhole.solidAngles())) {}

void CameraRenderer::begin(const WorldState& state) {
  state_ = state;
  view_ = cameraView(camera_.pinhole, cameraPose(camera_.mount, state), camera_.near_m, camera_.samples);
  small_ = findSmallBodies(simulation_, state_, view_, camera_.smallBody_px * camera_.samples);
  std::vector<char> drawn(small_.size());
  // The carrier would be seen from inside: a camera does not see the body it rides on.
  for (size_t e = 0; e < drawn.size(); ++e) drawn[e] = !small_[e] && static_cast<int>(e) != camera_.mount.carrier;
  pass_.setState(state_);
  pass_.draw(view_, state_, drawn);
  const bool lightsInView = std::any_of(simulation_.lights.begin(), simulation_.lights.end(), [](const auto& l) { return l.visible; });
  const bool anySmall = std::find(small_.begin(), small_.end(), 1) != small_.end();
  pass_.startReadback(lightsInView || anySmall);
}

CameraImage CameraRenderer::finish() {
  Subpixels image(plan_, view_, pass_.finishReadback());
  // Far bodies first, so that a nearer one hides its share of them.
  std::vector<std::pair<double, int>> order;
  for (size_t e = 0; e < small_.size(); ++e) {
    if (!small_[e] || static_cast<int>(e) == camera_.mount.carrier) continue;
    const glm::dvec3 p = glm::transpose(view_.localFromCamera) * (state_.entities[e].position - view_.position);
    const glm::dvec2 at = filmPosition(view_, p);
    const double margin = 2.0 * camera_.smallBody_px * camera_.samples;
    if (at.x < -margin || at.y < -margin || at.x > view_.width + margin || at.y > view_.height + margin) continue;
    order.emplace_back(-glm::length(p), static_cast<int>(e));
  }
  std::sort(order.begin(), order.end());
  for (const auto& [distance, e] : order) {
    // 256 across its bounding sphere, or 8 a subpixel: the area of a silhouette is sampled to about 0.1 %.
    const double extent = smallBodyExtent(simulation_, state_, view_, e);
    const View zoomed = zoomedView(simulation_, state_, view_, e, extent <= 32.0 ? 256 : extent <= 64.0 ? 512 : 1024);
    pass_.draw(zoomed, state_, {});
    pass_.startReadback(true);
    addSmallBody(image, zoomed, pass_.finishReadback(), state_, e);
  }
  addVisibleLights(image, simulation_, plan_, state_);
  CameraImage resolved = image.resolve(camera_.pinhole, camera_.samples);
  resolved.slotOfOutput = plan_.slotOfOutput;
  resolved.solidAngles = solidAngles_;
  return resolved;
}

}  // namespace pitviper
