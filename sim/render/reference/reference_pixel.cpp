#include "sim/render/reference/reference_pixel.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

struct Hit {
  int entity = -1, surface = -1;
  double distance = INFINITY;
  glm::dvec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< local frame
  glm::dvec2 uv{0.0};
};

/// Nearest triangle on a ray (direction of unit length), as far as z > near. Source: Moeller and Trumbore 1997.
Hit castRay(const Simulation& sim, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double nearest) {
  Hit hit;
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    const Pose& pose = state.entities[e];
    const glm::dmat3 localFromBody = glm::mat3_cast(pose.orientation);
    const glm::dvec3 o = glm::transpose(localFromBody) * (origin - pose.position), d = glm::transpose(localFromBody) * direction;
    const Mesh& mesh = *sim.entities[e].mesh;
    for (size_t s = 0; s < sim.entities[e].surfaces.size(); ++s) {
      const MeshPart& part = mesh.parts[sim.entities[e].surfaces[s].meshPart];
      for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t) {
        const glm::uvec3 i = mesh.triangles[t];
        const glm::dvec3 a(mesh.positions[i.x]), e1 = glm::dvec3(mesh.positions[i.y]) - a, e2 = glm::dvec3(mesh.positions[i.z]) - a;
        const glm::dvec3 p = glm::cross(d, e2);
        const double det = glm::dot(e1, p);
        if (det == 0.0) continue;
        const glm::dvec3 q = o - a;
        const double v = glm::dot(q, p) / det;
        const glm::dvec3 r = glm::cross(q, e1);
        const double w = glm::dot(d, r) / det, along = glm::dot(e2, r) / det;
        if (v < 0.0 || w < 0.0 || v + w > 1.0 || along < nearest || along >= hit.distance) continue;
        const double u = 1.0 - v - w;
        glm::dvec3 n = u * glm::dvec3(mesh.normals[i.x]) + v * glm::dvec3(mesh.normals[i.y]) + w * glm::dvec3(mesh.normals[i.z]);
        if (glm::dot(glm::cross(e1, e2), d) > 0.0) n = -n;
        hit = {static_cast<int>(e),
               static_cast<int>(s),
               along,
               origin + along * direction,
               localFromBody * glm::normalize(n),
               u * glm::dvec2(mesh.uv[i.x]) + v * glm::dvec2(mesh.uv[i.y]) + w * glm::dvec2(mesh.uv[i.z])};
      }
    }
  }
  return hit;
}

double textureValue(const Texture& t, glm::dvec2 uv) {
  const double x = uv.x * t.width - 0.5, y = uv.y * t.height - 0.5;
  const double cx = std::floor(x), cy = std::floor(y), fx = x - cx, fy = y - cy;
  auto at = [&](double i, double j) {
    auto wrap = [&t](double k, int n) { return static_cast<size_t>(t.repeats ? k - std::floor(k / n) * n : std::clamp(k, 0.0, n - 1.0)); };
    return static_cast<double>(t.texels[wrap(j, t.height) * static_cast<size_t>(t.width) + wrap(i, t.width)]);
  };
  return (1 - fy) * ((1 - fx) * at(cx, cy) + fx * at(cx + 1, cy)) + fy * ((1 - fx) * at(cx, cy + 1) + fx * at(cx + 1, cy + 1));
}

/// Light and view directions in a frame whose z is the normal.
glm::dvec3 inNormalFrame(const glm::dvec3& normal, const glm::dvec3& direction) {
  const glm::dvec3 helper = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
  return {glm::dot(direction, x), glm::dot(direction, y), glm::dot(direction, normal)};
}

}  // namespace

ReferencePixel referencePixel(const Simulation& sim, const Plan& plan, const View& view, const WorldState& state, int x, int y) {
  ReferencePixel pixel;
  const glm::dvec3 ray = view.ray(x + 0.5, y + 0.5);
  const glm::dvec3 direction = view.localFromCamera * ray / glm::length(ray);
  const Hit hit = castRay(sim, state, view.position, direction, view.near_m * glm::length(ray));
  pixel.entity = hit.entity;
  pixel.surface = hit.surface;
  const bool found = hit.entity >= 0;
  pixel.range_m = found ? hit.distance : physics::kFar;

  const double radius = sim.frame.earthRadius_m();
  const glm::dvec3 up = sim.frame.up(view.position);
  const double cameraHeight = sim.frame.height(view.position), sinElevation = glm::dot(direction, up);
  const double air = plan.terms.air ? sim.path->airLength_m(cameraHeight, sinElevation, pixel.range_m, radius) : 0.0;
  const double height = found ? sim.frame.height(hit.point) : 0.0;
  const glm::dvec3 upThere = found ? sim.frame.up(hit.point) : up;

  const glm::dvec3 toViewer = -direction;
  const Surface* surface = nullptr;
  const Material* material = nullptr;
  double mod[4] = {1.0, 1.0, 1.0, 1.0};
  glm::dvec3 view3(0, 0, 1);
  double viewAngle = 0.0;
  if (found) {
    surface = &sim.entities[static_cast<size_t>(hit.entity)].surfaces[static_cast<size_t>(hit.surface)];
    material = sim.materials[static_cast<size_t>(surface->material)].get();
    view3 = inNormalFrame(hit.normal, toViewer);
    view3.z = std::max(view3.z, 1e-6);
    pixel.cosView = view3.z;
    viewAngle = std::acos(std::min(1.0, view3.z));
    for (size_t k = 0; k < material->modifiers.size(); ++k)
      if (material->modifiers[k] >= 0) mod[k] = textureValue(sim.textures[static_cast<size_t>(material->modifiers[k])], hit.uv);
    if (material->given && material->given->modifier >= 0) mod[3] = textureValue(sim.textures[static_cast<size_t>(material->given->modifier)], hit.uv);
    pixel.temperature_K =
        surface->temperatureTexture >= 0 ? textureValue(sim.textures[static_cast<size_t>(surface->temperatureTexture)], hit.uv) : surface->temperature_K;
  }

  struct Leg {
    glm::dvec3 light;
    double factor = 0.0, air = 0.0;
  };
  std::vector<Leg> legs;
  auto addLeg = [&](const glm::dvec3& line, double radius_m, bool sun) {
    Leg leg;
    const double d2 = sun ? 1.0 : glm::dot(line, line), d = std::sqrt(d2);
    const glm::dvec3 to = d > 0.0 ? line / d : hit.normal;
    leg.light = inNormalFrame(hit.normal, to);
    leg.factor = sun ? std::max(leg.light.z, 0.0) : physics::pointIrradianceFactor(leg.light.z, d2, radius_m);
    if (plan.terms.air) {
      const bool endless = sim.path->top_m() >= physics::kFar;
      leg.air = air + (sun ? (endless ? 0.0 : sim.path->airLength_m(height, glm::dot(upThere, sim.sun->toSun), physics::kFar, radius))
                           : sim.path->airLength_m(height, glm::dot(upThere, to), d, radius));
    }
    legs.push_back(leg);
  };
  if (found) {
    for (size_t l = 0; l < sim.lights.size(); ++l) addLeg(state.lights[l] - hit.point, sim.lights[l].radius_m, false);
    if (sim.sun) addLeg(sim.sun->toSun, 0.0, true);
  }

  pixel.slots.assign(static_cast<size_t>(plan.slotCount), 0.0);
  for (size_t i = 0; i < plan.node_um.size(); ++i) {
    const double w = plan.node_um[i];
    double self = 0.0, reflected = 0.0;
    if (!found) {
      self = sim.background(w);
    } else {
      double reflectance = 0.0;
      for (size_t k = 0; k < material->reflections.size(); ++k) reflectance += mod[k] * material->reflections[k]->hemispherical(w, viewAngle);
      const double emissivity = material->given ? mod[3] * material->given->at(w, viewAngle) : 1.0 - reflectance;
      self = emissivity * physics::planckRadiance(w, pixel.temperature_K) + (plan.terms.ambient ? reflectance * (*sim.ambient)(w) : 0.0);
      for (size_t l = 0; l < legs.size(); ++l) {
        if (legs[l].factor <= 0.0) continue;
        double f = 0.0;
        for (size_t k = 0; k < material->reflections.size(); ++k) f += mod[k] * material->reflections[k]->brdf(w, legs[l].light, view3);
        const bool sun = l == sim.lights.size();
        const double strength = sun ? sim.sun->irradiance(w) : state.lightLevels[l] * sim.lights[l].intensity(w);
        reflected += f * legs[l].factor * strength * (plan.terms.air ? sim.path->transmittance(w, legs[l].air) : 1.0);
      }
    }
    const double radiance = (plan.terms.air ? self * sim.path->transmittance(w, air) + sim.path->radiance(w, air) : self) + reflected;
    pixel.radiance.push_back(radiance);
    for (size_t s = 0; s < pixel.slots.size(); ++s) pixel.slots[s] += plan.weight[s][i] * radiance;
  }
  return pixel;
}

}  // namespace pitviper
