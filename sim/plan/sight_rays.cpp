#include "sim/plan/sight_rays.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Of the rays.
constexpr double kAimed = 0.5;
/// Tries to hit on something that is in view at a time.
constexpr int kTries = 24;
/// Nothing is lower than this [m].
constexpr double kGround_m = -100.0;

}  // namespace

SightRays::SightRays(const Simulation& simulation, const Eye& eye, unsigned long long seed)
    : simulation_(simulation), eye_(eye), dice_(seed), drawn_(simulation.entities.size(), 1) {
  if (eye.camera && eye.camera->mount.carrier >= 0) drawn_[static_cast<size_t>(eye.camera->mount.carrier)] = 0;
  for (size_t e = 0; e < simulation.entities.size(); ++e)
    for (size_t s = 0; drawn_[e] && s < simulation.entities[e].surfaces.size(); ++s) surfaces_.emplace_back(e, s);
}

glm::dvec3 SightRays::placeOn(const WorldState& state, size_t surface) {
  const auto [e, s] = surfaces_[surface];
  const Entity& entity = simulation_.entities[e];
  const Mesh& mesh = *entity.mesh;
  const MeshPart& part = mesh.parts[entity.surfaces[s].meshPart];
  glm::dvec3 place(entity.boundingCentre);
  if (part.triangleCount > 0) {
    const glm::uvec3 t = mesh.triangles[part.firstTriangle + dice_.below(part.triangleCount)];
    double a = dice_.unit(), b = dice_.unit();
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    place = (1.0 - a - b) * glm::dvec3(mesh.positions[t.x]) + a * glm::dvec3(mesh.positions[t.y]) + b * glm::dvec3(mesh.positions[t.z]);
    // Inside a body of gas too, not its hull alone.
    if (simulation_.mediumOf(entity)) place = glm::mix(glm::dvec3(entity.boundingCentre), place, dice_.unit());
  }
  return state.entities[e].position + state.entities[e].orientation * place;
}

bool SightRays::inView(const SightRay& ray, const glm::dmat3& localFromCamera, const glm::dvec3& direction) const {
  if (eye_.probe) return glm::dot(direction, eye_.probe->normal) > 0.0;
  const Pinhole& p = eye_.camera->pinhole;
  const glm::dvec3 d = glm::transpose(localFromCamera) * direction;
  return glm::length(direction) > ray.nearest_m && d.z < 0.0 && std::abs(d.x) <= -d.z * p.tanX(p.width) && std::abs(d.y) <= -d.z * p.tanY(0);
}

/// To some place within the scenario's limits.
void SightRays::stretch(SightRay& ray, double distance_m) {
  const Limits& limits = simulation_.limits;
  if (limits.farthest_m > 0.0) {
    const double nearest = std::max(limits.nearest_m, std::max(ray.nearest_m, 0.1));
    const double range = nearest * std::pow(std::max(limits.farthest_m / nearest, 1.0), dice_.unit());
    // What is aimed at comes nearer or goes away with all that is around it, or the eye does; neither to under the ground.
    const glm::dvec3 away = (range - distance_m) * ray.direction, aim = ray.origin + distance_m * ray.direction;
    const bool eyeCan = simulation_.frame.height(ray.origin - away) > kGround_m, aimCan = simulation_.frame.height(aim + away) > kGround_m;
    if (eyeCan && (!aimCan || dice_.unit() < 0.5)) {
      ray.origin -= away;
    } else if (aimCan) {
      for (Pose& pose : ray.state.entities) pose.position += away;
      for (glm::dvec3& light : ray.state.lights) light += away;
    }
  }
  if (limits.hottest_K > 0.0) ray.temperature_K = limits.coldest_K + (limits.hottest_K - limits.coldest_K) * dice_.unit();
  if (limits.lightLevel > 0.0)
    for (double& level : ray.state.lightLevels) level = limits.lightLevel * dice_.unit();
}

double SightRays::pixel_sr() const {
  if (eye_.probe) return 4.0 / (static_cast<double>(eye_.probe->resolution) * eye_.probe->resolution);
  const Pinhole& p = eye_.camera->pinhole;
  const double across = static_cast<double>(eye_.camera->samples) * p.focalLength_m;
  return p.pitchX_m * p.pitchY_m / (across * across);
}

SightRay SightRays::draw() {
  SightRay ray;
  const TimeAxis& time = simulation_.time;
  ray.state = advance(simulation_.entities, simulation_.lights, time.start_s + time.step_s * (time.frames - 1) * dice_.unit());
  glm::dmat3 axes(1.0);
  if (eye_.camera) {
    const Pose pose = cameraPose(eye_.camera->mount, ray.state);
    axes = localFromCamera(pose);
    ray.origin = pose.position;
    ray.nearest_m = eye_.camera->near_m;
  } else {
    ray.origin = eye_.probe->position;
  }
  if (dice_.unit() < kAimed)
    for (int tries = 0; tries < kTries && !surfaces_.empty(); ++tries) {
      const glm::dvec3 line = placeOn(ray.state, dice_.below(surfaces_.size())) - ray.origin;
      if (!(glm::length(line) > 0.0) || !inView(ray, axes, line)) continue;
      ray.direction = glm::normalize(line);
      ray.fromFilm = false;
      if (simulation_.limits.any() && dice_.unit() < 0.5) stretch(ray, glm::length(line));
      return ray;
    }
  if (eye_.camera) {
    const Pinhole& p = eye_.camera->pinhole;
    ray.direction = glm::normalize(axes * glm::dvec3(p.tanX(p.width * dice_.unit()), p.tanY(p.height * dice_.unit()), -1.0));
  } else {
    const double z = dice_.unit(), phi = 2.0 * kPi * dice_.unit(), r = std::sqrt(1.0 - z * z);
    const glm::dvec3 n = glm::normalize(eye_.probe->normal), helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, n)), y = glm::cross(n, x);
    ray.direction = r * std::cos(phi) * x + r * std::sin(phi) * y + z * n;
  }
  return ray;
}

}  // namespace pitviper
