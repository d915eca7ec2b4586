#include "sim/render/small_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace pitviper {
namespace {

glm::dvec3 centreOf(const Simulation& sim, const WorldState& state, int entity) {
  const auto e = static_cast<size_t>(entity);
  return state.entities[e].position + state.entities[e].orientation * glm::dvec3(sim.entities[e].boundingCentre);
}

}  // namespace

double smallBodyExtent(const Simulation& sim, const WorldState& state, const View& v, int entity) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (centreOf(sim, state, entity) - v.position);
  const double radius = sim.entities[static_cast<size_t>(entity)].boundingRadius_m, depth = -p.z;
  if (depth <= 4.0 * radius + v.near_m || radius <= 0.0) return INFINITY;
  return 2.0 * radius / depth / std::min(v.tanPerPixelX, v.tanPerPixelY);
}

std::vector<char> findSmallBodies(const Simulation& sim, const WorldState& state, const View& v, double limit) {
  std::vector<char> small(sim.entities.size(), 0);
  for (size_t e = 0; e < sim.entities.size(); ++e) small[e] = smallBodyExtent(sim, state, v, static_cast<int>(e)) < limit;
  return small;
}

View zoomedView(const Simulation& sim, const WorldState& state, const View& v, int entity, int size) {
  constexpr double kRoll_rad = 0.3926;
  const auto e = static_cast<size_t>(entity);
  const double radius = sim.entities[e].boundingRadius_m;
  const glm::dvec3 line = centreOf(sim, state, entity) - v.position;
  const double distance = glm::length(line);
  View z;
  z.width = z.height = size;
  z.position = v.position;
  z.localFromCamera = localFromCamera({v.position, orientationAlong(line, kRoll_rad)});
  const double halfTan = 1.02 * radius / std::sqrt(distance * distance - radius * radius);
  z.tanPerPixelX = z.tanPerPixelY = 2.0 * halfTan / size;
  z.axisX = z.axisY = 0.5 * size;
  z.near_m = v.near_m;
  z.linearDepth = true;
  const glm::dvec3 centre = state.entities[e].orientation * glm::dvec3(sim.entities[e].boundingCentre);
  z.depthCentre_m = (glm::transpose(z.localFromCamera) * centre).z;
  z.depthRadius_m = 1.02 * radius;
  z.background = false;
  z.onlyEntity = entity;
  return z;
}

void addSmallBody(Subpixels& image, const View& z, const RawImage& zoomed, const WorldState& state, int entity) {
  const View& v = image.view();
  const glm::dmat3 mainFromZoom = glm::transpose(v.localFromCamera) * z.localFromCamera;
  const double originZ = (glm::transpose(z.localFromCamera) * (state.entities[static_cast<size_t>(entity)].position - z.position)).z;
  const size_t slots = zoomed.groups.size() * 4;
  struct Share {
    double coverage = 0.0;
    std::vector<double> sum;
    size_t sample = 0;
  };
  std::unordered_map<size_t, Share> shares;
  for (int j = 0; j < z.height; ++j)
    for (int i = 0; i < z.width; ++i) {
      const size_t q = static_cast<size_t>(j) * static_cast<size_t>(z.width) + static_cast<size_t>(i);
      if (zoomed.depth[q] <= 0.0f) continue;
      const glm::dvec3 ray = z.ray(i + 0.5, j + 0.5);
      const glm::dvec3 seen = mainFromZoom * ray;
      if (seen.z >= 0.0) continue;
      const glm::dvec2 at = filmPosition(v, seen);
      const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
      if (x < 0 || y < 0 || x >= v.width || y >= v.height) continue;
      const size_t p = image.index(x, y);
      // Distance of the sample along the main camera's axis against what stands there.
      const double turned = z.depthCentre_m + (static_cast<double>(zoomed.depth[q]) - 0.5) * 2.0 * z.depthRadius_m;
      const double scale = -(originZ + turned);
      if (-seen.z * scale > image.axialDepth_m(p)) continue;
      const double l2 = glm::dot(ray, ray);
      const double cosMain = -seen.z / std::sqrt(l2);
      const double etendue = z.tanPerPixelX * z.tanPerPixelY / (l2 * std::sqrt(l2)) * cosMain;
      Share& share = shares[p];
      share.sum.resize(slots, 0.0);
      share.sample = q;
      const double fraction = etendue / image.projectedSolidAngle_sr(x, y);
      share.coverage += fraction;
      for (size_t s = 0; s < slots; ++s) share.sum[s] += fraction * static_cast<double>(zoomed.groups[s / 4][4 * q + s % 4]);
    }
  for (auto& [p, share] : shares) {
    for (size_t s = 0; s < image.slotCount(); ++s) image.add(s, p, share.sum[s] - share.coverage * image.slot(s, p));
    if (!image.hasTruth() || share.coverage < 0.5) continue;
    TruthPixel truth = truthAt(zoomed, share.sample);
    const double subpixels = v.tanPerPixelX * v.tanPerPixelY / (z.tanPerPixelX * z.tanPerPixelY);
    truth.area_m2 = static_cast<float>(truth.area_m2 * subpixels);
    truth.solidAngleFromLight_sr = static_cast<float>(truth.solidAngleFromLight_sr * subpixels);
    image.setTruth(p, truth);
  }
}

}  // namespace pitviper
