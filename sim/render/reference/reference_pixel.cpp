#include "sim/render/reference/reference_pixel.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/ground.hpp"
#include "sim/model/light_legs.hpp"
#include "sim/model/ray_hits.hpp"
#include "sim/model/sunlit_air.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/reference/shadow_rays.hpp"

namespace pitviper {
namespace {

double textureValue(const Texture& t, glm::dvec2 uv) {
  const double x = uv.x * t.width - 0.5, y = uv.y * t.height - 0.5;
  const double cx = std::floor(x), cy = std::floor(y), fx = x - cx, fy = y - cy;
  auto at = [&](double i, double j) {
    auto wrap = [&t](double k, int n) { return static_cast<size_t>(t.repeats ? k - std::floor(k / n) * n : std::clamp(k, 0.0, n - 1.0)); };
    return static_cast<double>(t.texels[wrap(j, t.height) * static_cast<size_t>(t.width) + wrap(i, t.width)]);
  };
  return (1 - fy) * ((1 - fx) * at(cx, cy) + fx * at(cx + 1, cy)) + fy * ((1 - fx) * at(cx, cy + 1) + fx * at(cx + 1, cy + 1));
}

/// The camera's line of sight.
struct Sight {
  const Simulation& sim;
  const Plan& plan;
  const WorldState& state;
  glm::dvec3 position, direction;
  const ShadowCaster& shadows;

  AirRay airRay() const { return {sim.frame.height(position), glm::dot(direction, sim.frame.up(position)), sim.frame.earthRadius_m()}; }
};

/// The air from the camera to a place on the line of sight, per node.
struct Air {
  AirAmounts amounts;
  std::vector<double> transmittance, radiance;
};

/// The air's own places, and between them so many more that none is farther from the last than 100 m or a tenth of the way: emission, linear in
/// depth between two, is then within 3e-5 of finer ones towards space, where the model's own places are 0.13 % off, and closer nearby.
std::vector<AirStation> fineStations(const Path& path, const AirRay& ray, const std::vector<double>& ranges) {
  constexpr double kStep_m = 100.0, kPart = 0.1;
  std::vector<AirStation> own = path.stations(ray, ranges.back());
  if (own.size() < 2 || (!path.isLayered() && ranges.size() == 1)) return own;
  std::vector<double> at;
  if (!path.isLayered()) {
    at = {0.0};
    at.insert(at.end(), ranges.begin(), ranges.end());
    return path.stationsAt(ray, at);
  }
  for (const AirStation& s : own) at.push_back(s.range_m);
  const double begin = at.front(), end = at.back();
  for (double r : ranges)
    if (r > begin && r < end) at.push_back(r);
  std::sort(at.begin(), at.end());
  std::vector<double> all = {begin};
  for (size_t i = 1; i < at.size(); ++i) {
    const double step = at[i] - at[i - 1];
    const int parts = std::max(1, static_cast<int>(std::ceil(step / std::max(kStep_m, kPart * (at[i - 1] - begin)))));
    for (int k = 1; k < parts; ++k) all.push_back(at[i - 1] + step * k / parts);
    all.push_back(at[i]);
  }
  return path.stationsAt(ray, all);
}

/// The air as far as each of some places on the line of sight: its geometry once, for all of them and all nodes.
class AirLine {
 public:
  /// `ranges_m`: in any order.
  AirLine(const Sight& sight, std::vector<double> ranges_m) : range_m_(std::move(ranges_m)) {
    const auto& nodes = sight.plan.nodes;
    std::sort(range_m_.begin(), range_m_.end());
    range_m_.erase(std::unique(range_m_.begin(), range_m_.end()), range_m_.end());
    air_.assign(range_m_.size(), {{}, std::vector<double>(nodes.size(), 1.0), std::vector<double>(nodes.size(), 0.0)});
    if (!sight.plan.terms.air) return;
    const Simulation& sim = sight.sim;
    const AirRay ray = sight.airRay();
    RaySun sun;
    if (sim.sun) sun = {glm::dot(sim.sun->toSun, sim.frame.up(sight.position)), glm::dot(sight.direction, sim.sun->toSun)};
    const bool sunlit = sight.plan.terms.scatteredSun;
    const SunlitAir line(*sim.path, ray, fineStations(*sim.path, ray, range_m_), sunlit ? sight.plan.sunLegs.get() : nullptr, sun);
    if (line.stations.empty()) return;
    std::vector<size_t> station;  // the last one that lies no farther
    for (double r : range_m_) {
      const auto after = std::upper_bound(line.stations.begin(), line.stations.end(), r, [](double x, const AirStation& s) { return x < s.range_m; });
      station.push_back(after == line.stations.begin() ? line.stations.size() : static_cast<size_t>(after - line.stations.begin()) - 1);
      if (station.back() < line.stations.size()) air_[station.size() - 1].amounts = line.stations[station.back()].amounts;
    }
    std::vector<double> source(line.stations.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
      for (size_t s = 0; s < source.size(); ++s) source[s] = line.stations[s].temperature_K > 0.0 ? nodes[i].planck(line.stations[s].temperature_K) : 0.0;
      const AirRadiance radiance = airRadiance(nodes[i].air, line, source);
      const double irradiance = sunlit ? nodes[i].mean(sim.sun->irradiance) : 0.0;
      const double molecules = irradiance * rayleighPhase(sun.cosScatter), haze = irradiance * henyeyGreensteinPhase(sun.cosScatter, nodes[i].air.asymmetry);
      for (size_t r = 0; r < air_.size(); ++r) {
        const size_t s = station[r];
        if (s == line.stations.size()) continue;  // before the air begins
        air_[r].transmittance[i] = std::exp(-radiance.depth[s]);
        air_[r].radiance[i] = radiance.thermal[s] + (sunlit ? molecules * radiance.molecules[s] + haze * radiance.haze[s] : 0.0);
      }
    }
  }
  /// As far as one of the places given.
  const Air& at(double range_m) const { return air_[static_cast<size_t>(std::lower_bound(range_m_.begin(), range_m_.end(), range_m) - range_m_.begin())]; }

 private:
  std::vector<double> range_m_;
  std::vector<Air> air_;
};

/// A surface's own radiance (emission, reflection) and transmittance per node, as seen from the camera, the air's own radiance left out.
struct Seen {
  std::vector<double> radiance, transmittance;
  double cosView = 0.0, temperature_K = 0.0;
};

Seen lookAt(const Sight& sight, const Hit& hit, const Air& air) {
  const Simulation& sim = sight.sim;
  const Plan& plan = sight.plan;
  Seen seen;
  const Surface& surface = surfaceAt(sim, hit);
  const Material& material = sim.materialOf(surface);
  glm::dvec3 view3 = inNormalFrame(hit.normal, -sight.direction);
  view3.z = std::max(view3.z, 1e-6);
  seen.cosView = view3.z;
  const double viewAngle = std::acos(std::min(1.0, view3.z));
  auto modifier = [&](int texture) { return texture < 0 ? 1.0 : textureValue(sim.textures[static_cast<size_t>(texture)], hit.uv); };
  double mod[3] = {1.0, 1.0, 1.0};
  for (size_t k = 0; k < material.modifiers.size(); ++k) mod[k] = modifier(material.modifiers[k]);
  const double modE = material.given ? modifier(material.given->modifier) : 1.0, modT = material.transmission ? modifier(material.transmission->modifier) : 1.0;
  seen.temperature_K =
      surface.temperatureTexture >= 0 ? textureValue(sim.textures[static_cast<size_t>(surface.temperatureTexture)], hit.uv) : surface.temperature_K;

  struct Leg {
    glm::dvec3 light;
    double factor = 0.0;
    AirAmounts powered;
  };
  std::vector<Leg> legs;
  for (size_t l = 0; l < sim.lights.size() + (sim.sun ? 1 : 0); ++l) {
    const LightLeg way = lightLeg(sim, sight.state, hit, l);
    Leg leg{inNormalFrame(hit.normal, way.toLight), way.factor, {}};
    const double radius_m = l < sim.lights.size() ? sim.lights[l].radius_m : 0.0;
    if (hit.entity < 0) leg.factor = l == sim.lights.size() ? leg.factor : 0.0;  // the ground: the sun's light alone, and no shadows
    else if (leg.factor > 0.0 && plan.terms.shadows && !sight.shadows.lit(sight.state, hit, way.toLight, way.distance_m - radius_m)) leg.factor = 0.0;
    if (plan.terms.air) leg.powered = sim.path->powered(air.amounts + way.air);
    legs.push_back(leg);
  }

  for (size_t i = 0; i < plan.nodes.size(); ++i) {
    const SpectralNode& n = plan.nodes[i];
    double reflected = 0.0;
    for (size_t l = 0; l < legs.size(); ++l) {
      if (legs[l].factor <= 0.0) continue;
      double f = 0.0;
      for (size_t k = 0; k < material.reflections.size(); ++k)
        f += mod[k] * n.mean([&](double w) { return material.reflections[k]->brdf(w, legs[l].light, view3); });
      const double strength = l == sim.lights.size() ? n.mean(sim.sun->irradiance) : sight.state.lightLevels[l] * n.mean(sim.lights[l].intensity);
      reflected += f * legs[l].factor * strength * (plan.terms.air ? std::exp(-Path::depthOf(n.air, legs[l].powered)) : 1.0);
    }
    const double self = n.mean([&](double w) {
      double reflectance = 0.0;
      for (size_t k = 0; k < material.reflections.size(); ++k) reflectance += mod[k] * material.reflections[k]->hemispherical(w, viewAngle);
      const double emissivity = material.given ? modE * material.given->at(w, viewAngle) : 1.0 - reflectance - modT * material.transmittance(w, viewAngle);
      return emissivity * physics::planckRadiance(w, seen.temperature_K) + (plan.terms.ambient ? reflectance * (*sim.ambient)(w) : 0.0);
    });
    seen.radiance.push_back(self * air.transmittance[i] + reflected);
    seen.transmittance.push_back(modT * n.mean([&](double w) { return material.transmittance(w, viewAngle); }));
  }
  return seen;
}

/// Everything transparent over what is behind, from the far end to the camera: the ray is cut at every surface and at every border of a
/// medium, so that media in each other and surfaces inside them are right too.
void addTransparent(const Sight& sight, const RayHits& hits, const AirLine& line, std::vector<double>& radiance) {
  std::vector<double> cuts;
  for (const Stretch& s : hits.stretches) cuts.insert(cuts.end(), {s.enter, s.leave});
  for (const Hit& h : hits.layers) cuts.push_back(h.distance);
  std::sort(cuts.begin(), cuts.end(), std::greater<>());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  const auto& nodes = sight.plan.nodes;
  for (size_t c = 0; c < cuts.size(); ++c) {
    for (const Hit& h : hits.layers)
      if (h.distance == cuts[c]) {
        const Air& air = line.at(h.distance);
        const Seen seen = lookAt(sight, h, air);
        for (size_t i = 0; i < nodes.size(); ++i)
          radiance[i] = seen.transmittance[i] * radiance[i] + (1.0 - seen.transmittance[i]) * air.radiance[i] + seen.radiance[i];
      }
    if (c + 1 == cuts.size()) break;
    const double far = cuts[c], near = cuts[c + 1];
    std::vector<int> inside;
    for (const Stretch& s : hits.stretches)
      if (s.enter <= near && s.leave >= far) inside.push_back(s.entity);
    if (inside.empty()) continue;
    const Air &farAir = line.at(far), &nearAir = line.at(near);
    for (size_t i = 0; i < nodes.size(); ++i) {
      double a = 0.0, source = 0.0;
      for (int e : inside) {
        const Entity& body = sight.sim.entities[static_cast<size_t>(e)];
        const Surface& surface = body.surfaces.front();
        const double own = nodes[i].absorption_per_m[static_cast<size_t>(surface.material)] * (far - near);
        a += own;
        source += own * nodes[i].mean([&](double w) { return sight.sim.mediumOf(body)->source(w, surface.temperature_K); });
      }
      if (a <= 0.0) continue;
      const double tau = nearAir.transmittance[i], before = nearAir.radiance[i], between = farAir.radiance[i] - before;
      const double air = -std::log(std::max(farAir.transmittance[i], 1e-300) / std::max(tau, 1e-300));
      radiance[i] = std::exp(-a) * (radiance[i] - before - between) + physics::mediumRadiance(a, std::max(air, 0.0), before, between, tau, source / a);
    }
  }
}

}  // namespace

ReferenceShader::ReferenceShader(const Simulation& simulation, const Plan& plan, const View& view, const WorldState& state, const std::vector<char>& drawn)
    : simulation_(simulation), plan_(plan), view_(view), state_(state), drawn_(drawn), transparent_(simulation.hasTransparent()), shadows_(simulation) {}

ReferencePixel ReferenceShader::pixel(int x, int y) const {
  const glm::dvec3 ray = view_.ray(x + 0.5, y + 0.5);
  return shade(x, y, castRay(simulation_, state_, view_.position, view_.localFromCamera * ray / glm::length(ray), view_.near_m * glm::length(ray), &drawn_));
}

ReferencePixel ReferenceShader::pixel(int x, int y, const SeenTriangle& seen) const {
  const glm::dvec3 ray = view_.ray(x + 0.5, y + 0.5), direction = view_.localFromCamera * ray / glm::length(ray);
  RayHits hits;
  if (seen.entity >= 0) hits.solid = hitOf(simulation_, state_, view_.position, direction, seen.entity, seen.triangle);
  if (transparent_) {
    // What is transparent, before the solid surface that is known already.
    RayHits all = castRay(simulation_, state_, view_.position, direction, view_.near_m * glm::length(ray), &drawn_, true);
    std::erase_if(all.layers, [&](const Hit& h) { return h.distance > hits.solid.distance; });
    for (Stretch& s : all.stretches) s.leave = std::min(s.leave, hits.solid.distance);
    std::erase_if(all.stretches, [](const Stretch& s) { return s.leave <= s.enter; });
    hits.layers = std::move(all.layers);
    hits.stretches = std::move(all.stretches);
  }
  return shade(x, y, hits);
}

bool ReferenceShader::meets(int x, int y, int entity) const {
  const glm::dvec3 ray = view_.ray(x + 0.5, y + 0.5);
  std::vector<char> alone(simulation_.entities.size(), 0);
  alone[static_cast<size_t>(entity)] = 1;
  const RayHits hits = castRay(simulation_, state_, view_.position, view_.localFromCamera * ray / glm::length(ray), view_.near_m * glm::length(ray), &alone);
  return hits.solid.entity >= 0 || !hits.layers.empty() || !hits.stretches.empty();
}

std::vector<double> ReferenceShader::transmittance(double farthest_m) const {
  std::vector<double> all(plan_.nodes.size(), 1.0);
  if (!transparent_) return all;
  const glm::dvec3 ray = view_.ray(0.5 * view_.width, 0.5 * view_.height), direction = view_.localFromCamera * ray / glm::length(ray);
  const Sight sight{simulation_, plan_, state_, view_.position, direction, shadows_};
  const RayHits hits = castRay(simulation_, state_, view_.position, direction, view_.near_m * glm::length(ray), &drawn_, true);
  const double end = farthest_m * glm::length(ray);
  const Air noAir{{}, all, std::vector<double>(all.size(), 0.0)};
  for (const Hit& h : hits.layers) {
    if (h.distance > end) continue;
    const Seen seen = lookAt(sight, h, noAir);
    for (size_t i = 0; i < all.size(); ++i) all[i] *= seen.transmittance[i];
  }
  for (const Stretch& s : hits.stretches) {
    const size_t material = static_cast<size_t>(simulation_.entities[static_cast<size_t>(s.entity)].surfaces.front().material);
    const double length = std::min(s.leave, end) - s.enter;
    if (length > 0.0)
      for (size_t i = 0; i < all.size(); ++i) all[i] *= std::exp(-plan_.nodes[i].absorption_per_m[material] * length);
  }
  return all;
}

ReferencePixel ReferenceShader::shade(int x, int y, const RayHits& hits) const {
  const Simulation& sim = simulation_;
  const Plan& plan = plan_;
  ReferencePixel pixel;
  const glm::dvec3 ray = view_.ray(x + 0.5, y + 0.5);
  const Sight sight{sim, plan, state_, view_.position, view_.localFromCamera * ray / glm::length(ray), shadows_};
  pixel.entity = hits.solid.entity;
  pixel.surface = hits.solid.surface;
  const std::optional<Hit> found = hits.solid.entity >= 0 ? hits.solid : groundHit(sim, sight.position, sight.direction);
  const double end = found ? found->distance : physics::kFar;
  pixel.range_m = end;
  std::vector<double> places = {end};
  for (const Stretch& s : hits.stretches) places.insert(places.end(), {s.enter, s.leave});
  for (const Hit& h : hits.layers) places.push_back(h.distance);
  const AirLine line(sight, std::move(places));
  const Air& air = line.at(end);
  if (found) {
    Seen seen = lookAt(sight, *found, air);
    pixel.cosView = seen.cosView;
    pixel.temperature_K = seen.temperature_K;
    pixel.radiance = std::move(seen.radiance);
  } else {
    for (size_t i = 0; i < plan.nodes.size(); ++i) pixel.radiance.push_back(plan.nodes[i].mean(sim.background) * air.transmittance[i]);
  }
  for (size_t i = 0; i < plan.nodes.size(); ++i) pixel.radiance[i] += air.radiance[i];
  addTransparent(sight, hits, line, pixel.radiance);
  pixel.slots.assign(static_cast<size_t>(plan.slotCount), 0.0);
  for (size_t s = 0; s < pixel.slots.size(); ++s)
    for (size_t i = 0; i < plan.nodes.size(); ++i) pixel.slots[s] += plan.weight[s][i] * pixel.radiance[i];
  return pixel;
}

ReferencePixel referencePixel(const Simulation& sim, const Plan& plan, const View& view, const WorldState& state, int x, int y) {
  const std::vector<char> all(sim.entities.size(), 1);
  return ReferenceShader(sim, plan, view, state, all).pixel(x, y);
}

}  // namespace pitviper
