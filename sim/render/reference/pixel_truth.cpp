#include "sim/render/reference/pixel_truth.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/world/ground.hpp"
#include "sim/world/ray_hits.hpp"

namespace pitviper {

TruthPixel truthOf(const Simulation& sim, const WorldState& state, const View& v, const LineOfSight& line, double apertureArea_m2, double textureAccuracy,
                   bool lamps) {
  const auto ground = line.hits.solid.entity < 0 ? groundHit(sim, line.origin, line.direction) : std::nullopt;
  if (line.hits.solid.entity < 0 && !ground) return {};
  const Hit& hit = ground ? *ground : line.hits.solid;
  const double cosPsi = -glm::dot(line.direction, v.localFromCamera[2]), cosView = std::max(-glm::dot(hit.normal, line.direction), 1e-6);
  const double area_m2 = physics::fragmentArea(physics::pixelSolidAngle(v.pixelTan2, cosPsi), hit.distance, cosView);
  double fromLight_sr = 0.0;
  if (lamps && hit.entity >= 0 && !sim.lights.empty()) {
    const glm::dvec3 to = state.lights[0] - hit.point;
    const double distance2 = glm::dot(to, to), cosine = distance2 > 0.0 ? glm::dot(hit.normal, to) / std::sqrt(distance2) : 0.0;
    if (cosine > 0.0) fromLight_sr = physics::fragmentFromLight(area_m2, cosine, distance2);
  }
  const Surface& surface = surfaceAt(sim, hit);
  const double temperature_K =
      surface.temperatureTexture < 0
          ? temperatureAt(sim, state, hit)
          : textureMoments(sim.textures[static_cast<std::size_t>(surface.temperatureTexture)], hit.uv, hit.footprint, tapsFor(textureAccuracy)).mean;
  const auto single = [](double x) { return static_cast<float>(x); };
  return {single(area_m2),
          single(fromLight_sr),
          single(physics::apertureFromFragment(apertureArea_m2, cosPsi, hit.distance)),
          single(hit.distance),
          {single(hit.normal.x), single(hit.normal.y), single(glm::dot(hit.normal, sim.frame.up(v.position)))},
          single(temperature_K),
          single(hit.entity + 1),
          single(hit.surface + 1),
          single(cosView)};
}

TruthPixel truthSeen(const Simulation& sim, const WorldState& state, const View& v, const glm::dvec2& place, const std::vector<char>& present,
                     double apertureArea_m2, double textureAccuracy, bool lamps) {
  const glm::dvec3 ray = v.localFromCamera * v.ray(place.x, place.y);
  const double length = glm::length(ray);
  LineOfSight line{v.position, ray / length, castRay(sim, state, v.position, ray / length, v.near_m * length, &present, false, 0), 0.0};
  if (textureAccuracy > 0.0 && line.hits.solid.entity >= 0)
    line.hits.solid.footprint = footprintOf(sim, state, line.hits.solid, ray, v.localFromCamera * glm::dvec3(v.tanPerPixelX, 0.0, 0.0),
                                            v.localFromCamera * glm::dvec3(0.0, v.tanPerPixelY, 0.0));
  return truthOf(sim, state, v, line, apertureArea_m2, textureAccuracy, lamps);
}

}  // namespace pitviper
