#include "sim/render/small_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "sim/model/ray_hits.hpp"

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
  z.zoomed = true;
  z.depthCentre = centre;
  z.depthRadius_m = 1.02 * radius;
  return z;
}

/// What zoomed samples say of one subpixel of the image.
struct Share {
  double looked = 0.0;   ///< projected solid angle of all zoomed samples in it [sr]
  double covered = 0.0;  ///< of those that count: what they see takes the place of what the image has there
  std::vector<double> sum;
  size_t sample = 0;  ///< one of them
  double cosPsi = 1.0;
};
using Shares = std::map<size_t, Share>;

/// Calls visit(zoomed pixel, subpixel, projected solid angle, cosine to the image's axis) for each zoomed sample that falls into the image.
template <class Visit>
void eachSample(const Subpixels& image, const View& z, const Visit& visit) {
  const View& v = image.view();
  const glm::dmat3 mainFromZoom = glm::transpose(v.localFromCamera) * z.localFromCamera;
  for (int j = 0; j < z.height; ++j)
    for (int i = 0; i < z.width; ++i) {
      const glm::dvec3 ray = z.ray(i + 0.5, j + 0.5), seen = mainFromZoom * ray;
      if (seen.z >= 0.0) continue;
      const glm::dvec2 at = filmPosition(v, seen);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height)) continue;
      const double l2 = glm::dot(ray, ray), cosPsi = -seen.z / std::sqrt(l2);
      const double etendue = z.tanPerPixelX * z.tanPerPixelY / (l2 * std::sqrt(l2)) * cosPsi;
      visit(static_cast<size_t>(j) * static_cast<size_t>(z.width) + static_cast<size_t>(i), image.index(static_cast<int>(at.x), static_cast<int>(at.y)),
            etendue, cosPsi);
    }
}

/// By subpixel, of the samples that count.
template <class Counts>
Shares sharesOf(const Subpixels& image, const View& z, const RawImage& zoomed, const Counts& counts) {
  Shares shares;
  eachSample(image, z, [&](size_t q, size_t p, double etendue, double cosPsi) {
    Share& share = shares[p];
    share.looked += etendue;
    if (!counts(q)) return;
    share.covered += etendue;
    share.sample = q;
    share.cosPsi = cosPsi;
    share.sum.resize(image.slotCount(), 0.0);
    for (size_t s = 0; s < image.slotCount(); ++s) share.sum[s] += etendue * static_cast<double>(zoomed.groups[s / 4][4 * q + s % 4]);
  });
  return shares;
}

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

/// The truth of a subpixel that a body covers by half or more.
void takeTruth(Subpixels& image, const RawImage& zoomed, const Share& share, double whole, size_t pixel) {
  if (!image.hasTruth() || share.covered < 0.5 * whole) return;
  TruthPixel truth = truthAt(zoomed, share.sample);  // the zoomed view's axis points at the body: put the angle off the real one in
  truth.area_m2 = static_cast<float>(truth.area_m2 * std::pow(share.cosPsi, 3));
  truth.solidAngleFromLight_sr = static_cast<float>(truth.solidAngleFromLight_sr * std::pow(share.cosPsi, 3));
  truth.solidAngleOfAperture_sr = static_cast<float>(truth.solidAngleOfAperture_sr * share.cosPsi);
  image.setTruth(pixel, truth);
}

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

/// What is sampled finely in a subpixel, by all zoomed views that look at it, each at directions of its own.
struct Fine {
  double covered = 0.0;  ///< projected solid angle [sr]
  double whole = 0.0;    ///< of the subpixel
  std::vector<double> sum;
};
using FineSubpixels = std::map<size_t, Fine>;

void gather(Subpixels& image, const View& z, const RawImage& zoomed, const Shares& shares, FineSubpixels& fine) {
  const View& v = image.view();
  const glm::dmat3 zoomFromMain = glm::transpose(z.localFromCamera) * v.localFromCamera;
  for (const auto& [p, share] : shares) {
    if (share.covered <= 0.0) continue;
    const int x = static_cast<int>(p % static_cast<size_t>(v.width)), y = static_cast<int>(p / static_cast<size_t>(v.width));
    const double whole = isInside(v, z, zoomFromMain, x, y) ? share.looked : image.projectedSolidAngle_sr(x, y);
    Fine& f = fine[p];
    f.sum.resize(image.slotCount(), 0.0);
    f.covered += share.covered;
    f.whole = std::max(f.whole, whole);
    for (size_t s = 0; s < f.sum.size(); ++s) f.sum[s] += share.sum[s];
    takeTruth(image, zoomed, share, whole, p);
  }
}

/// The image keeps what it has in the rest of a subpixel: a mean of radiances, none of which is below 0.
void put(Subpixels& image, const FineSubpixels& fine) {
  for (const auto& [p, f] : fine) {
    const double whole = std::max(f.whole, f.covered);  // samples fall to one side or the other of a subpixel's edge
    for (size_t s = 0; s < f.sum.size(); ++s) image.add(s, p, (f.sum[s] - f.covered * image.slot(s, p)) / whole);
  }
}

bool anyOf(const std::vector<char>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](char f) { return f != 0; });
}

/// The samples of a zoomed view that fall into wanted subpixels.
std::shared_ptr<const std::vector<char>> marksOf(const Subpixels& image, const View& z, const std::vector<char>& wanted) {
  auto marks = std::make_shared<std::vector<char>>(static_cast<size_t>(z.width) * static_cast<size_t>(z.height), 0);
  eachSample(image, z, [&](size_t q, size_t p, double, double) { (*marks)[q] = wanted[p]; });
  return marks;
}

/// A solid body that nothing transparent is near: where it shows it takes the place of what is behind it.
void drawSolid(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, int entity, const std::vector<char>& drawn, int samples,
               const std::vector<char>* wanted, FineSubpixels& fine) {
  View z = zoomedView(sim, state, image.view(), entity, zoomedSize(extentOf(sim, state, image.view(), entity), samples));
  if (wanted) {
    z.wanted = marksOf(image, z, *wanted);
    if (!anyOf(*z.wanted)) return;
  }
  pass.draw(z, state, drawn);
  pass.startReadback(false, true);
  const RawImage zoomed = pass.finishReadback();
  gather(image, z, zoomed, sharesOf(image, z, zoomed, [&](size_t q) { return zoomed.entity[q] == entity && (!wanted || (*z.wanted)[q]); }), fine);
}

/// Bodies that are seen through something or that something is seen through, all in their places in every picture. A direction is sampled by the
/// finest view that looks at it: a small hot thing behind a large puff by its own, not by the puff's.
class MixedBodies {
 public:
  MixedBodies(const Simulation& sim, const WorldState& state, const View& v, const std::vector<int>& bodies, int samples)
      : sim_(sim), state_(state), bodies_(bodies) {
    std::stable_sort(bodies_.begin(), bodies_.end(), [&](int x, int y) { return extentOf(sim, state, v, x) < extentOf(sim, state, v, y); });
    for (int e : bodies_) {
      const bool medium = sim.mediumOf(sim.entities[static_cast<size_t>(e)]) != nullptr;
      views_.push_back(zoomedView(sim, state, v, e, zoomedSize(extentOf(sim, state, v, e), medium ? samples / 2 : samples)));
      views_.back().onlyEntity = -1;
    }
  }
  /// `others`: what else is in the picture.
  void draw(Subpixels& image, ScenePass& pass, std::vector<char> drawn, const std::vector<char>* wanted, FineSubpixels& fine) const {
    for (int e : bodies_) drawn[static_cast<size_t>(e)] = 1;
    for (size_t i = 0; i < views_.size(); ++i) {
      View z = views_[i];
      z.wanted = meeting(image, i, wanted);
      if (!anyOf(*z.wanted)) continue;
      pass.draw(z, state_, drawn);
      pass.startReadback(false, true);
      const RawImage zoomed = pass.finishReadback();
      gather(image, z, zoomed, sharesOf(image, z, zoomed, [&](size_t q) { return (*z.wanted)[q] != 0; }), fine);
    }
  }

 private:
  /// Marks the samples of a view that meet one of the bodies, and that no finer view has.
  std::shared_ptr<const std::vector<char>> meeting(const Subpixels& image, size_t index, const std::vector<char>* wanted) const {
    const View& z = views_[index];
    auto marks = std::make_shared<std::vector<char>>(static_cast<size_t>(z.width) * static_cast<size_t>(z.height), 0);
    eachSample(image, z, [&](size_t q, size_t p, double, double) {
      if (wanted && !(*wanted)[p]) return;
      const glm::dvec3 ray = z.ray(static_cast<double>(q % static_cast<size_t>(z.width)) + 0.5, static_cast<double>(q / static_cast<size_t>(z.width)) + 0.5);
      const glm::dvec3 direction = z.localFromCamera * ray / glm::length(ray);
      for (size_t j = 0; j < index; ++j)
        if (looksAt(views_[j], direction)) return;
      (*marks)[q] =
          std::any_of(bodies_.begin(), bodies_.end(), [&](int e) { return meetsBody(sim_, state_, z.position, direction, z.near_m * glm::length(ray), e); });
    });
    return marks;
  }
  static bool looksAt(const View& z, const glm::dvec3& direction) {
    const glm::dvec3 p = glm::transpose(z.localFromCamera) * direction;
    if (p.z >= 0.0) return false;
    const glm::dvec2 at = filmPosition(z, p);
    return at.x >= 0.0 && at.y >= 0.0 && at.x < z.width && at.y < z.height;
  }
  const Simulation& sim_;
  const WorldState& state_;
  std::vector<int> bodies_;  ///< the smallest first
  std::vector<View> views_;
};

}  // namespace

std::vector<char> findSmallBodies(const Simulation& sim, const WorldState& state, const View& v, double limit) {
  std::vector<char> small(sim.entities.size(), 0);
  for (size_t e = 0; e < sim.entities.size(); ++e) small[e] = extentOf(sim, state, v, static_cast<int>(e)) < limit;
  return small;
}

void addSmallBodies(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, const std::vector<char>& small,
                    const std::vector<char>& present, int zoomedSamples, const std::vector<char>* wanted) {
  const View& v = image.view();
  std::vector<int> bodies;
  std::vector<char> others = present;
  for (size_t e = 0; e < small.size(); ++e) {
    if (!small[e] || !present[e]) continue;
    others[e] = 0;
    if (mayShow(v, centreOf(sim, state, static_cast<int>(e)), sim.entities[e].boundingRadius_m)) bodies.push_back(static_cast<int>(e));
  }
  const std::vector<char> mixed = overlapTransparent(sim, state, v, bodies);

  // Each zoomed view shows what the others hide, and directions are shared out among them: their order does not matter.
  std::vector<char> solids = others;
  std::vector<int> together;
  for (size_t i = 0; i < bodies.size(); ++i) {
    solids[static_cast<size_t>(bodies[i])] = !mixed[i];
    if (mixed[i]) together.push_back(bodies[i]);
  }
  FineSubpixels fine;
  for (size_t i = 0; i < bodies.size(); ++i)
    if (!mixed[i]) drawSolid(image, pass, sim, state, bodies[i], solids, zoomedSamples, wanted, fine);
  MixedBodies(sim, state, v, together, zoomedSamples).draw(image, pass, others, wanted, fine);
  put(image, fine);
}

}  // namespace pitviper
