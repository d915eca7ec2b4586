#include "sim/camera/probe.hpp"

#include <cmath>

#include "sim/model/light_legs.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/reference/reference_pass.hpp"
#include "sim/camera/small_bodies.hpp"
#include "sim/camera/visible_lights.hpp"

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

std::vector<double> measureProbe(const Simulation& sim, const Probe& probe, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
                                 const WorldState& state) {
  const Plan plan = planFor(sim, {nullptr, &probe});
  const auto owned =
      probe.spectral.reference ? std::make_unique<ReferencePass>(sim, plan, library, scene, false, 1.0) : makeScenePass(sim, plan, library, scene, false, 1.0);
  ScenePass& pass = *owned;
  pass.setState(state);
  const std::vector<char> all(sim.entities.size(), 1);
  const glm::dvec3 normal = glm::normalize(probe.normal);
  std::vector<double> sums(static_cast<size_t>(plan.slotCount), 0.0);
  for (const View& v : hemisphere(probe)) {
    const auto small = findSmallBodies(sim, state, v, 16.0);  // as a camera's default: a far body falls between rays otherwise
    std::vector<char> drawn(all);
    for (size_t e = 0; e < drawn.size(); ++e) drawn[e] = !small[e];
    pass.draw(v, state, drawn);
    pass.startReadback();
    Subpixels image(plan, v, pass.finishReadback());
    addSmallBodies(image, pass, sim, state, small, all, Camera{}.zoomedSamples);
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x) {
        const glm::dvec3 ray = v.ray(x + 0.5, y + 0.5);
        const double l2 = glm::dot(ray, ray);
        const double cosine = glm::dot(v.localFromCamera * ray, normal) / std::sqrt(l2);
        if (cosine <= 0.0) continue;
        const double weight = cosine * v.tanPerPixelX * v.tanPerPixelY / (l2 * std::sqrt(l2));
        for (size_t s = 0; s < sums.size(); ++s) sums[s] += weight * image.slot(s, image.index(x, y));
      }
  }
  const WaysToLights ways(sim, plan);
  for (size_t l = 0; l < sim.lights.size(); ++l) {
    const glm::dvec3 line = state.lights[l] - probe.position;
    const double d = glm::length(line), cosine = d > 0.0 ? glm::dot(line, normal) / d : 0.0;
    if (cosine <= 0.0 || state.lightLevels[l] <= 0.0) continue;
    const auto way = ways.from(state, all, probe.position, line / d, d, kNear_m);
    if (way.empty()) continue;
    const double factor = physics::pointIrradianceFactor(cosine, d * d, sim.lights[l].radius_m);
    const auto intensity = apparentIntensity(sim, plan, state, l, probe.position, way);
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += factor * intensity[s];
  }
  const SunHere sun = sim.sun ? sunHere(sim, probe.position) : SunHere{{}, 0.0, {}};
  const double cosine = glm::dot(sun.toSun, normal);
  const std::vector<double> toSun =
      sun.share > 0.0 && cosine > 0.0 ? ways.from(state, all, probe.position, sun.toSun, physics::kFar, kNear_m) : std::vector<double>();
  for (size_t i = 0; i < toSun.size(); ++i) {
    const SpectralNode& n = plan.nodes[i];
    const double e = toSun[i] * sun.share * cosine * n.mean(sim.sun->irradiance) * (plan.terms.air ? sim.air->transmittance(n.air, sun.air) : 1.0);
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += plan.weight[s][i] * e;
  }
  std::vector<double> values;
  for (size_t o = 0; o < probe.outputs.size(); ++o) values.push_back(probe.outputs[o].scale * sums[static_cast<size_t>(plan.slotOfOutput[o])]);
  return values;
}

}  // namespace pitviper
