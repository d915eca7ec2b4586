#include "sim/render/small_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace pitviper {
namespace {

glm::dvec3 centreOf(const Simulation& sim, const WorldState& state, int entity) {
  const auto e = static_cast<size_t>(entity);
  return state.entities[e].position + state.entities[e].orientation * glm::dvec3(sim.entities[e].boundingCentre);
}

/// Diameter of an entity's bounding sphere [subpixels of the view]; infinite where it comes near the camera's plane.
double extentOf(const Simulation& sim, const WorldState& state, const View& v, int entity) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (centreOf(sim, state, entity) - v.position);
  const double radius = sim.entities[static_cast<size_t>(entity)].boundingRadius_m, depth = -p.z;
  if (depth <= 4.0 * radius + v.near_m || radius <= 0.0) return INFINITY;
  return 2.0 * radius / depth / std::min(v.tanPerPixelX, v.tanPerPixelY);
}

/// From the same place, turned so that the entity's bounding sphere fills the picture, and rolled by an angle that no edge of a scene
/// shares, so that silhouettes are sampled evenly (an edge along the grid would be off by up to a whole row).
View zoomedView(const Simulation& sim, const WorldState& state, const View& v, int entity, int size) {
  constexpr double kRoll_rad = 0.3926;
  const double radius = sim.entities[static_cast<size_t>(entity)].boundingRadius_m;
  const glm::dvec3 centre = centreOf(sim, state, entity), line = centre - v.position;
  const double distance = glm::length(line);
  View z = v;
  z.width = z.height = size;
  z.localFromCamera = localFromCamera({v.position, orientationAlong(line, kRoll_rad)});
  z.tanPerPixelX = z.tanPerPixelY = 2.04 * radius / std::sqrt(distance * distance - radius * radius) / size;
  z.axisX = z.axisY = 0.5 * size;
  z.onlyEntity = entity;
  z.depthCentre = centre;
  z.depthRadius_m = 1.02 * radius;
  return z;
}

/// What falls into one subpixel of the image.
struct Share {
  double looked = 0.0;   ///< projected solid angle of all zoomed samples in it [sr]
  double covered = 0.0;  ///< of those that see the body
  std::vector<double> sum;
  size_t sample = 0;
  double cosPsi = 1.0;
};

/// True where a subpixel lies wholly inside the zoomed picture: its samples then make up the whole of it.
bool isInside(const View& main, const View& zoomed, const glm::dmat3& zoomFromMain, int x, int y) {
  for (int corner = 0; corner < 4; ++corner) {
    const glm::dvec3 p = zoomFromMain * main.ray(x + (corner & 1), y + (corner >> 1));
    if (p.z >= 0.0) return false;
    const glm::dvec2 at = filmPosition(zoomed, p);
    if (at.x < 0.0 || at.y < 0.0 || at.x > zoomed.width || at.y > zoomed.height) return false;
  }
  return true;
}

/// By subpixel. The sums are those of the samples that see the entity, or, beside a picture without it, of the differences of all samples.
std::map<size_t, Share> sharesOf(const Subpixels& image, const View& z, int entity, const RawImage& zoomed, const RawImage* without = nullptr) {
  const View& v = image.view();
  const glm::dmat3 mainFromZoom = glm::transpose(v.localFromCamera) * z.localFromCamera;
  std::map<size_t, Share> shares;
  for (int j = 0; j < z.height; ++j)
    for (int i = 0; i < z.width; ++i) {
      const glm::dvec3 ray = z.ray(i + 0.5, j + 0.5), seen = mainFromZoom * ray;
      if (seen.z >= 0.0) continue;
      const glm::dvec2 at = filmPosition(v, seen);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height)) continue;
      const size_t q = static_cast<size_t>(j) * static_cast<size_t>(z.width) + static_cast<size_t>(i);
      const double l2 = glm::dot(ray, ray), cosPsi = -seen.z / std::sqrt(l2);
      const double etendue = z.tanPerPixelX * z.tanPerPixelY / (l2 * std::sqrt(l2)) * cosPsi;
      Share& share = shares[image.index(static_cast<int>(at.x), static_cast<int>(at.y))];
      share.looked += etendue;
      const bool covered = zoomed.entity[q] == entity;
      if (covered) {
        share.covered += etendue;
        share.sample = q;
        share.cosPsi = cosPsi;
      } else if (!without) {
        continue;
      }
      share.sum.resize(image.slotCount(), 0.0);
      for (size_t s = 0; s < image.slotCount(); ++s) {
        const double beside = without ? static_cast<double>(without->groups[s / 4][4 * q + s % 4]) : 0.0;
        share.sum[s] += etendue * (static_cast<double>(zoomed.groups[s / 4][4 * q + s % 4]) - beside);
      }
    }
  return shares;
}

/// The truth of a subpixel that a body covers by half or more.
void takeTruth(Subpixels& image, const RawImage& zoomed, const Share& share, double whole, size_t pixel) {
  if (!image.hasTruth() || share.covered < 0.5 * whole) return;
  TruthPixel truth = truthAt(zoomed, share.sample);  // the zoomed view's axis points at the body: put the angle off the real one in
  truth.area_m2 = static_cast<float>(truth.area_m2 * std::pow(share.cosPsi, 3));
  truth.solidAngleFromLight_sr = static_cast<float>(truth.solidAngleFromLight_sr * std::pow(share.cosPsi, 3));
  truth.solidAngleOfAperture_sr = static_cast<float>(truth.solidAngleOfAperture_sr * share.cosPsi);
  image.setTruth(pixel, truth);
}

struct Delta {
  size_t pixel;
  std::vector<double> slots;
};

/// With 256 across the bounding sphere the area of a silhouette is sampled to about 0.1 %; at least 8 a subpixel.
int zoomedSize(double extent, int samples) {
  int size = samples;
  while (size < 8.0 * extent && size < 4096) size *= 2;
  return size;
}

/// Flags, in order, the bodies that are transparent or overlap one that is, directly or through others.
std::vector<char> overlapTransparent(const Simulation& sim, const WorldState& state, const View& v, const std::vector<int>& bodies) {
  std::vector<char> mixed(bodies.size(), 0);
  std::vector<size_t> open;
  std::vector<glm::dvec3> line;
  std::vector<double> sine;  // of the angular radius
  for (size_t i = 0; i < bodies.size(); ++i) {
    const glm::dvec3 to = centreOf(sim, state, bodies[i]) - v.position;
    line.push_back(glm::normalize(to));
    sine.push_back(static_cast<double>(sim.entities[static_cast<size_t>(bodies[i])].boundingRadius_m) / glm::length(to));
    if (!sim.isTransparent(sim.entities[static_cast<size_t>(bodies[i])])) continue;
    mixed[i] = 1;
    open.push_back(i);
  }
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    for (size_t j = 0; j < bodies.size(); ++j)
      if (!mixed[j] && glm::length(line[i] - line[j]) < 1.1 * (sine[i] + sine[j])) {  // small angles, with some room
        mixed[j] = 1;
        open.push_back(j);
      }
  }
  return mixed;
}

/// A solid body: its radiance where it shows takes the place of the background's.
void drawSolid(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, int entity, const std::vector<char>& drawn, int samples,
               std::vector<Delta>& deltas) {
  const View& v = image.view();
  const View z = zoomedView(sim, state, v, entity, zoomedSize(extentOf(sim, state, v, entity), samples));
  pass.draw(z, state, drawn);
  pass.startReadback(false, true);
  const RawImage zoomed = pass.finishReadback();
  const glm::dmat3 zoomFromMain = glm::transpose(z.localFromCamera) * v.localFromCamera;
  for (auto& [p, share] : sharesOf(image, z, entity, zoomed)) {
    if (share.covered <= 0.0) continue;
    const int x = static_cast<int>(p % static_cast<size_t>(v.width)), y = static_cast<int>(p / static_cast<size_t>(v.width));
    const double whole = isInside(v, z, zoomFromMain, x, y) ? share.looked : image.projectedSolidAngle_sr(x, y);
    Delta d{p, std::vector<double>(image.slotCount())};
    for (size_t s = 0; s < d.slots.size(); ++s) d.slots[s] = (share.sum[s] - share.covered * image.slot(s, p)) / whole;
    deltas.push_back(std::move(d));
    takeTruth(image, zoomed, share, whole, p);
  }
}

/// A body that is seen through something or that something is seen through: the same zoomed view with and without it, everything else in
/// place that has been added to the image before it. The differences, over their solid angle, are what the image lacks; so several of them
/// add up, whatever hides or dims what.
void addDifference(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, int entity, std::vector<char> others, int samples) {
  const View& v = image.view();
  const bool medium = sim.mediumOf(sim.entities[static_cast<size_t>(entity)]) != nullptr;
  View z = zoomedView(sim, state, v, entity, zoomedSize(extentOf(sim, state, v, entity), medium ? samples / 2 : samples));
  z.onlyEntity = -1;
  z.differenceOf = entity;
  auto drawn = [&] {
    pass.draw(z, state, others);
    pass.startReadback(false, true);
    return pass.finishReadback();
  };
  const RawImage without = drawn();
  others[static_cast<size_t>(entity)] = 1;
  const RawImage with = drawn();
  const glm::dmat3 zoomFromMain = glm::transpose(z.localFromCamera) * v.localFromCamera;
  for (const auto& [p, share] : sharesOf(image, z, entity, with, &without)) {
    const int x = static_cast<int>(p % static_cast<size_t>(v.width)), y = static_cast<int>(p / static_cast<size_t>(v.width));
    const double whole = isInside(v, z, zoomFromMain, x, y) ? share.looked : image.projectedSolidAngle_sr(x, y);
    for (size_t s = 0; s < image.slotCount(); ++s) image.add(s, p, share.sum[s] / whole);
    takeTruth(image, with, share, whole, p);
  }
}

}  // namespace

std::vector<char> findSmallBodies(const Simulation& sim, const WorldState& state, const View& v, double limit) {
  std::vector<char> small(sim.entities.size(), 0);
  for (size_t e = 0; e < sim.entities.size(); ++e) small[e] = extentOf(sim, state, v, static_cast<int>(e)) < limit;
  return small;
}

void addSmallBodies(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, const std::vector<char>& small,
                    const std::vector<char>& present, int zoomedSamples) {
  const View& v = image.view();
  std::vector<int> bodies;
  std::vector<char> others = present;
  for (size_t e = 0; e < small.size(); ++e) {
    if (!small[e] || !present[e]) continue;
    others[e] = 0;
    if (mayShow(v, centreOf(sim, state, static_cast<int>(e)), sim.entities[e].boundingRadius_m)) bodies.push_back(static_cast<int>(e));
  }
  const std::vector<char> mixed = overlapTransparent(sim, state, v, bodies);

  // Solid bodies by themselves: each zoomed view shows what the others hide, so their order does not matter.
  std::vector<char> solids = others;
  for (size_t i = 0; i < bodies.size(); ++i) solids[static_cast<size_t>(bodies[i])] = !mixed[i];
  std::vector<Delta> deltas;
  for (size_t i = 0; i < bodies.size(); ++i)
    if (!mixed[i]) drawSolid(image, pass, sim, state, bodies[i], solids, zoomedSamples, deltas);
  for (const auto& d : deltas)
    for (size_t s = 0; s < d.slots.size(); ++s) image.add(s, d.pixel, d.slots[s]);

  // Where something transparent takes part: the largest first, each on top of those before it. So each is sampled by a view of its own
  // size, and never by the coarser one of a larger body: a small hot thing behind a large puff must cancel to the last digit.
  std::vector<int> order;
  for (size_t i = 0; i < bodies.size(); ++i)
    if (mixed[i]) order.push_back(bodies[i]);
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return extentOf(sim, state, v, x) > extentOf(sim, state, v, y); });
  for (int e : order) {
    addDifference(image, pass, sim, state, e, others, zoomedSamples);
    others[static_cast<size_t>(e)] = 1;
  }
}

}  // namespace pitviper
