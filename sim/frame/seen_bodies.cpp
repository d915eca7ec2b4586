#include "sim/frame/seen_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sim/world/ray_hits.hpp"
#include "sim/world/view.hpp"

namespace pitviper {
namespace {

/// Places on a body, and columns and rows of the grid over the film. In crowds fewer, so that thousands of bodies take seconds.
constexpr int kPlaces = 96, kPlacesOfMany = 12, kGrid = 16;
constexpr size_t kMany = 256;
/// Vertices that an outline is made of; of larger meshes every n-th.
constexpr size_t kMostVertices = 100000;
/// A place is hit where the ray ends within this part of its range: rounding of single-precision vertices.
constexpr double kSame = 1e-5;

struct MeshLook {
  glm::dvec3 low{INFINITY}, high{-INFINITY};
  std::vector<glm::dvec3> places;  ///< body axes
};

/// Places spread by area: a golden-ratio sequence over the sum of triangle areas, and points within a triangle by two more. The same every time.
MeshLook lookAt(const Mesh& mesh, int count) {
  MeshLook look;
  for (const glm::vec3& p : mesh.positions) look.low = glm::min(look.low, glm::dvec3(p)), look.high = glm::max(look.high, glm::dvec3(p));
  std::vector<double> upTo;
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    upTo.push_back(sum += 0.5 * glm::length(glm::cross(b - a, c - a)));
  }
  for (int k = 0; k < count && sum > 0.0; ++k) {
    const double at = (k + 0.5) / count * sum;
    const size_t triangle = std::min(static_cast<size_t>(std::upper_bound(upTo.begin(), upTo.end(), at) - upTo.begin()), upTo.size() - 1);
    const glm::uvec3 t = mesh.triangles[triangle];
    // Source of the two steps: Roberts 2018, the plastic number's additive recurrence.
    double u = std::fmod(0.5 + k * 0.7548776662466927, 1.0), v = std::fmod(0.5 + k * 0.5698402909980532, 1.0);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    look.places.push_back((1.0 - u - v) * glm::dvec3(mesh.positions[t.x]) + u * glm::dvec3(mesh.positions[t.y]) + v * glm::dvec3(mesh.positions[t.z]));
  }
  return look;
}

class Looker {
 public:
  Looker(const Simulation& sim, const Camera& camera, const WorldState& state)
      : sim_(sim),
        state_(state),
        view_(cameraView(camera, state, 1)),
        cameraFromLocal_(glm::transpose(view_.localFromCamera)),
        present_(sim.entities.size(), 1),
        onFilm_(sim.entities.size(), 0),
        carrier_(camera.mount.carrier) {
    if (carrier_ >= 0) present_[static_cast<size_t>(carrier_)] = 0;
  }

  std::vector<BodySight> look() {
    castOverFilm();
    std::vector<BodySight> all;
    for (size_t e = 0; e < sim_.entities.size(); ++e) all.push_back(lookAtBody(e));
    return all;
  }

 private:
  glm::dvec3 centreOf(size_t e) const {
    const Pose& pose = state_.entities[e];
    return pose.position + pose.orientation * glm::dvec3(sim_.entities[e].boundingCentre);
  }
  double radiusOf(size_t e) const { return static_cast<double>(sim_.entities[e].boundingRadius_m); }

  /// Which bodies a grid of rays over the film meets: what is large is found so, wherever its places lie.
  void castOverFilm() {
    for (int j = 0; j < kGrid; ++j)
      for (int i = 0; i < kGrid; ++i) {
        const glm::dvec3 r = view_.localFromCamera * glm::normalize(view_.ray((i + 0.5) * view_.width / kGrid, (j + 0.5) * view_.height / kGrid));
        const RayHits hits = castRay(sim_, state_, view_.position, r, view_.near_m, &present_, false, 0);
        auto note = [&](int e) { onFilm_[static_cast<size_t>(e)] = 1; };
        if (hits.solid.entity >= 0) note(hits.solid.entity);
        for (const Hit& h : hits.layers) note(h.entity);
        for (const Stretch& s : hits.stretches) note(s.entity);
      }
  }

  /// Flags of those that may stand before a body: their bounding spheres meet the cone from the camera round its own.
  std::vector<char> before(size_t e) const {
    std::vector<char> some(present_);
    const glm::dvec3 line = centreOf(e) - view_.position;
    const double range = glm::length(line), radius = radiusOf(e);
    if (range <= radius) return some;
    for (size_t k = 0; k < some.size(); ++k) {
      if (!some[k] || k == e) continue;
      const glm::dvec3 to = centreOf(k) - view_.position;
      const double along = std::clamp(glm::dot(to, line) / range, 0.0, range + radius);
      const double reach = radiusOf(k) + radius * along / (range - radius);
      some[k] = glm::length(to - line * (along / range)) <= reach;
    }
    return some;
  }

  /// The box round its outline on the film. False where all of it is nearer than the camera draws.
  bool outline(size_t e, BodySight& s, bool& beside) const {
    const Entity& body = sim_.entities[e];
    const Pose& pose = state_.entities[e];
    const size_t step = body.mesh->positions.size() / kMostVertices + 1;
    glm::dvec2 low(INFINITY), high(-INFINITY);
    bool front = false, behind = false;
    for (size_t v = 0; v < body.mesh->positions.size(); v += step) {
      const glm::dvec3 p = cameraFromLocal_ * (pose.position + pose.orientation * glm::dvec3(body.mesh->positions[v]) - view_.position);
      if (-p.z < view_.near_m) {
        behind = true;
        continue;
      }
      front = true;
      const glm::dvec2 at = filmPosition(view_, p);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    if (!front) return false;
    s.width_px = behind ? std::numeric_limits<double>::infinity() : high.x - low.x;
    s.height_px = behind ? std::numeric_limits<double>::infinity() : high.y - low.y;
    s.cut = behind || low.x < 0.0 || low.y < 0.0 || high.x > view_.width || high.y > view_.height;
    beside = !behind && (high.x < 0.0 || high.y < 0.0 || low.x > view_.width || low.y > view_.height);
    return true;
  }

  BodySight lookAtBody(size_t e) {
    const Entity& body = sim_.entities[e];
    const Pose& pose = state_.entities[e];
    const auto [known, fresh] = looks_.try_emplace(body.mesh.get());
    if (fresh) known->second = lookAt(*body.mesh, sim_.entities.size() > kMany ? kPlacesOfMany : kPlaces);
    const MeshLook& look = known->second;
    BodySight s;
    s.size_m = look.high - look.low;
    const glm::dvec3 centre = centreOf(e);
    const double radius = radiusOf(e);
    s.range_m = glm::length(centre - view_.position);
    if (s.range_m < radius)
      for (const glm::dvec3& p : look.places) s.range_m = std::min(s.range_m, glm::length(pose.position + pose.orientation * p - view_.position));
    if (!state_.isThere(e)) {
      s.sight = HowSeen::Absent;
      return s;
    }
    if (static_cast<int>(e) == carrier_) {
      s.sight = HowSeen::Carrier;
      return s;
    }
    if ((cameraFromLocal_ * (centre - view_.position)).z > radius) {
      s.sight = HowSeen::Behind;
      return s;
    }
    bool beside = false;
    if (!outline(e, s, beside)) {
      s.sight = (cameraFromLocal_ * (centre - view_.position)).z > 0.0 ? HowSeen::Behind : HowSeen::TooNear;
      return s;
    }
    if (beside || !mayShow(view_, centre, radius)) return s;
    castToPlaces(e, look, s);
    return s;
  }

  void castToPlaces(size_t e, const MeshLook& look, BodySight& s) {
    const Pose& pose = state_.entities[e];
    const std::vector<char> candidates = before(e);
    int within = 0, hidden = 0, seen = 0;
    std::map<int, int> hiders, veils;
    for (const glm::dvec3& place : look.places) {
      const glm::dvec3 line = pose.position + pose.orientation * place - view_.position, p = cameraFromLocal_ * line;
      if (-p.z < view_.near_m) continue;
      const glm::dvec2 at = filmPosition(view_, p);
      if (at.x < 0.0 || at.y < 0.0 || at.x > view_.width || at.y > view_.height) continue;
      ++within;
      const double range = glm::length(line);
      const RayHits hits = castRay(sim_, state_, view_.position, line / range, view_.near_m, &candidates, false, 0);
      if (hits.solid.entity >= 0 && hits.solid.entity != static_cast<int>(e) && hits.solid.distance < range * (1.0 - kSame)) {
        ++hidden;
        ++hiders[hits.solid.entity];
        continue;
      }
      ++seen;
      std::map<int, bool> once;
      for (const Hit& h : hits.layers)
        if (h.entity != static_cast<int>(e) && h.distance < range) once[h.entity] = true;
      for (const Stretch& m : hits.stretches)
        if (m.entity != static_cast<int>(e) && m.enter < range) once[m.entity] = true;
      for (const auto& [veil, yes] : once) ++veils[veil];
    }
    auto most = [](const std::map<int, int>& counts) {
      const auto found = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
      return found == counts.end() ? std::pair(-1, 0) : std::pair(found->first, found->second);
    };
    // A few places within the film are no measure of a share.
    if (4 * within >= static_cast<int>(look.places.size())) s.hidden = static_cast<double>(hidden) / within;
    s.hiddenBy = most(hiders).first;
    if (const auto [veil, count] = most(veils); 2 * count > seen) s.through = veil;
    if (seen > 0 || onFilm_[e]) s.sight = HowSeen::InView;
    else if (hidden > 0) s.sight = HowSeen::Hidden;
    if (s.sight == HowSeen::InView && seen == 0) s.hidden = 0.0;  // the film sees what lies between them
  }

  const Simulation& sim_;
  const WorldState& state_;
  View view_;
  glm::dmat3 cameraFromLocal_;
  std::vector<char> present_, onFilm_;
  int carrier_;
  std::map<const Mesh*, MeshLook> looks_;
};

}  // namespace

std::vector<BodySight> bodiesSeen(const Simulation& sim, const Camera& camera, const WorldState& state) { return Looker(sim, camera, state).look(); }

}  // namespace pitviper
