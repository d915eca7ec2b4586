#include "sim/camera/probe.hpp"

#include <cmath>

#include "sim/camera/small_bodies.hpp"
#include "sim/camera/visible_lights.hpp"
#include "sim/camera/zoomed_lines.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/reference/reference_drawer.hpp"
#include "sim/render/scene_pass.hpp"
#include "sim/world/light_legs.hpp"

namespace pitviper {
namespace {

constexpr double kNear_m = 1e-3;

/// The five views of the upper hemisphere's cube: the top face, and the upper half of each side face.
std::vector<View> hemisphere(const Probe& probe) {
  constexpr double kTurn_rad = 0.3926;
  const glm::dvec3 up = glm::normalize(probe.normal);
  const glm::dvec3 helper = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 a0 = glm::normalize(glm::cross(helper, up)), b0 = glm::cross(up, a0);
  const glm::dvec3 a = std::cos(kTurn_rad) * a0 + std::sin(kTurn_rad) * b0, b = glm::cross(up, a);
  std::vector<View> views;
  for (int face = 0; face < 5; ++face) {
    View v;
    const glm::dvec3 forward = face == 0 ? up : face == 1 ? a : face == 2 ? -a : face == 3 ? b : -b;
    const glm::dvec3 top = face == 0 ? a : up;
    v.localFromCamera = glm::dmat3(glm::cross(forward, top), top, -forward);
    v.width = probe.resolution;
    v.height = face == 0 ? probe.resolution : probe.resolution / 2;
    v.tanPerPixelX = v.tanPerPixelY = 2.0 / probe.resolution;
    v.axisX = 0.5 * probe.resolution;
    v.axisY = face == 0 ? 0.5 * probe.resolution : 0.0;  // a side face begins at the horizon
    v.position = probe.position;
    v.near_m = kNear_m;
    views.push_back(v);
  }
  return views;
}

}  // namespace

ProbeMeter::ProbeMeter(const Simulation& simulation, const Probe& probe, Plan plan, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene)
    : simulation_(simulation),
      probe_(probe),
      normal_(glm::normalize(probe.normal)),
      plan_(std::move(plan)),
      ways_(simulation, plan_),
      all_(simulation.entities.size(), 1),
      lines_(zoomedLines(simulation, Camera{}.zoomedSamples, probe.spectral.reference ? 0.0 : plan_.accuracy)) {
  if (probe.spectral.reference) drawer_ = std::make_unique<ReferenceDrawer>(simulation, plan_, library, scene, false, 1.0);
  else drawer_ = makeScenePass(simulation, plan_, library, scene, false, 1.0, false);
}

void ProbeMeter::addSurroundings(const WorldState& state, std::vector<double>& sums) {
  for (const View& v : hemisphere(probe_)) {
    const auto small = findSmallBodies(simulation_, state, v, 16.0);  // as a camera's default: a far body falls between rays otherwise
    std::vector<char> drawn(all_);
    for (size_t e = 0; e < drawn.size(); ++e) drawn[e] = !small[e];
    drawer_->draw(v, state, drawn);
    drawer_->startReadback();
    Subpixels image(plan_, v, drawer_->finishReadback());
    addSmallBodies(image, *drawer_, simulation_, state, small, all_, lines_);
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x) {
        const glm::dvec3 ray = v.ray(x + 0.5, y + 0.5);
        const double l2 = glm::dot(ray, ray);
        const double cosine = glm::dot(v.localFromCamera * ray, normal_) / std::sqrt(l2);
        if (cosine <= 0.0) continue;
        const double weight = cosine * v.tanPerPixelX * v.tanPerPixelY / (l2 * std::sqrt(l2));
        for (size_t s = 0; s < sums.size(); ++s) sums[s] += weight * image.slot(s, image.index(x, y));
      }
  }
}

void ProbeMeter::addLights(const WorldState& state, std::vector<double>& sums) const {
  for (size_t l = 0; l < simulation_.lights.size(); ++l) {
    const glm::dvec3 line = state.lights[l] - probe_.position;
    const double d = glm::length(line), cosine = d > 0.0 ? glm::dot(line, normal_) / d : 0.0;
    if (cosine <= 0.0 || state.lightLevels[l] <= 0.0) continue;
    const auto way = ways_.from(state, all_, probe_.position, line / d, d, kNear_m);
    if (way.empty()) continue;
    const double factor = physics::pointIrradianceFactor(cosine, d * d, simulation_.lights[l].radius_m);
    const auto intensity = apparentIntensity(simulation_, plan_, state, l, probe_.position, way);
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += factor * intensity[s];
  }
}

void ProbeMeter::addSun(const WorldState& state, std::vector<double>& sums) const {
  if (!simulation_.sun) return;
  const SunHere sun = sunHere(simulation_, probe_.position);
  const double cosine = glm::dot(sun.toSun, normal_);
  if (!(sun.share > 0.0 && cosine > 0.0)) return;
  const std::vector<double> way = ways_.from(state, all_, probe_.position, sun.toSun, physics::kFar, kNear_m);
  for (size_t i = 0; i < way.size(); ++i) {
    const SpectralNode& n = plan_.nodes[i];
    const double e =
        way[i] * sun.share * cosine * n.mean(simulation_.sun->irradiance) * (plan_.terms.air ? simulation_.air->transmittance(n.air, sun.air) : 1.0);
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += plan_.weight[s][i] * e;
  }
}

std::vector<double> ProbeMeter::read(const WorldState& state) {
  drawer_->setState(state);
  std::vector<double> sums(static_cast<size_t>(plan_.slotCount), 0.0), values;
  addSurroundings(state, sums);
  addLights(state, sums);
  addSun(state, sums);
  for (size_t o = 0; o < probe_.outputs.size(); ++o) values.push_back(probe_.outputs[o].scale * sums[static_cast<size_t>(plan_.slotOfOutput[o])]);
  return values;
}

}  // namespace pitviper
