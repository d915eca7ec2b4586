#include "sim/scene/import/polygon_cutter.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
double lengthOf(const glm::dvec2& v) { return std::abs(v.x) + std::abs(v.y); }

}  // namespace

PolygonCutter::Result PolygonCutter::cut(std::span<const glm::dvec3> corners, double noise, Triangles& triangles) {
  const auto hasArea = [&](Result result) { return result == Result::Cut && covers(corners, triangles); };
  const Result first = cutWithin(corners, noise, triangles);
  // What is as small as the noise may still have a shape; and edges that cross by little may be meant to touch: files round.
  if (hasArea(first) || hasArea(cutWithin(corners, 0.0, triangles))) return Result::Cut;
  for (const double more : {1.0, 16.0, 256.0, 4096.0})
    if (hasArea(cutWithin(mergedWithin(corners, more * noise), more * noise, triangles))) return Result::Cut;
  triangles.clear();
  return first == Result::Flat ? Result::Flat : Result::Crossing;
}

/// Whether triangles have the polygon's area without covering anything twice, in the plane that it was projected onto.
bool PolygonCutter::covers(std::span<const glm::dvec3> corners, const Triangles& triangles) const {
  constexpr double kOverlap = 1e-4;  // a tenth of what a picture is asked for at best
  const auto doubled = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return cross({b[u_] - a[u_], b[v_] - a[v_]}, {c[u_] - a[u_], c[v_] - a[v_]});
  };
  double area = 0.0, covered = 0.0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) area += doubled(corners[0], corners[k], corners[k + 1]);
  for (const auto& t : triangles) covered += std::abs(doubled(corners[t[0]], corners[t[1]], corners[t[2]]));
  return std::abs(covered - area) <= kOverlap * area;
}

std::span<const glm::dvec3> PolygonCutter::mergedWithin(std::span<const glm::dvec3> corners, double noise) {
  merged_.assign(corners.begin(), corners.end());
  for (std::size_t i = 1; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (glm::all(glm::lessThanEqual(glm::abs(corners[i] - merged_[j]), glm::dvec3(2.0 * noise)))) {
        merged_[i] = merged_[j];
        break;
      }
  return merged_;
}

PolygonCutter::Result PolygonCutter::cutWithin(std::span<const glm::dvec3> corners, double noise, Triangles& triangles) {
  triangles.clear();
  ring_.clear();
  // Corners that are left once those written twice in a row, and ways there and back, are out.
  const auto last = [&](std::size_t k) -> const glm::dvec3& { return corners[ring_[ring_.size() - k]]; };
  for (Corner k = 0; k < corners.size(); ++k) {
    ring_.push_back(k);
    while (ring_.size() > 1 && (last(1) == last(2) || (ring_.size() > 2 && last(1) == last(3)))) {
      if (last(1) != last(2)) ring_.pop_back();
      ring_.pop_back();
    }
  }
  if (ring_.size() < 3) return Result::Flat;

  // Newell's normal, twice the area: it tells the plane of corners that don't quite lie in one. Source: Sutherland, Sproull and Schumacker 1974.
  const glm::dvec3 origin = corners[ring_[0]];
  glm::dvec3 normal(0.0), farthest(0.0);
  double around = 0.0;
  for (std::size_t k = 0; k < ring_.size(); ++k) {
    const glm::dvec3 a = corners[corner(k)] - origin, b = corners[corner(k + 1)] - origin;
    normal += glm::cross(a, b);
    around += glm::length(b - a);
    if (glm::length(a) > glm::length(farthest)) farthest = a;
  }
  constexpr double kRounding = 1e-15;  // of products of doubles
  noise_ = std::max(noise, kRounding * around);
  if (glm::length(normal) <= noise_ * around) {
    double aside = 0.0;
    for (const Corner c : ring_) aside = std::max(aside, glm::length(glm::cross(farthest, corners[c] - origin)));
    return aside > 4.0 * noise_ * around ? Result::Crossing : Result::Flat;
  }
  flatten(corners, normal);
  dropSpikes();
  if (!isConvex() && crosses()) return Result::Crossing;
  while (ring_.size() > 2 && (cutBest(true, triangles) || cutBest(false, triangles))) dropSpikes();
  // Corners on one line are left where nothing else is.
  return ring_.size() < 3 || std::abs(doubleArea()) <= noise_ * around ? Result::Cut : Result::Crossing;
}

/// Onto the coordinate plane where it is largest: coordinates stay as they are, and corners on one line do.
void PolygonCutter::flatten(std::span<const glm::dvec3> corners, const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int away = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  u_ = (away + 1) % 3, v_ = (away + 2) % 3;
  if (normal[away] < 0.0) std::swap(u_, v_);
  flat_.clear();
  for (const glm::dvec3& p : corners) flat_.emplace_back(p[u_] - corners[0][u_], p[v_] - corners[0][v_]);
}

/// 1: c lies left of the way from a to b; 0: on its line, as well as can be told.
int PolygonCutter::turn(Corner a, Corner b, Corner c) const {
  const glm::dvec2 ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a];
  const double side = cross(ab, ac), rounding = noise_ * (lengthOf(ab) + lengthOf(ac));
  return side > rounding ? 1 : side < -rounding ? -1 : 0;
}

double PolygonCutter::doubleArea() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < ring_.size(); ++k) sum += cross(flat_[corner(k)] - flat_[ring_[0]], flat_[corner(k + 1)] - flat_[ring_[0]]);
  return sum;
}

bool PolygonCutter::isConvex() const {
  const std::size_t n = ring_.size();
  for (std::size_t k = 0; k < n; ++k)
    if (turn(corner(k), corner(k + 1), corner(k + 2)) < 0 || turn(ring_[0], corner(k), corner(k + 1)) < 0) return false;
  return true;
}

/// Whether two edges cross in their middles. Edges that touch don't.
bool PolygonCutter::crosses() const {
  const std::size_t n = ring_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Corner a = ring_[i], b = corner(i + 1);
    const glm::dvec2 low = glm::min(flat_[a], flat_[b]), high = glm::max(flat_[a], flat_[b]);
    for (std::size_t j = i + 2; j < n; ++j) {
      const Corner c = ring_[j], d = corner(j + 1);
      const glm::dvec2 p = flat_[c], q = flat_[d];
      if (std::max(p.x, q.x) < low.x || std::min(p.x, q.x) > high.x || std::max(p.y, q.y) < low.y || std::min(p.y, q.y) > high.y) continue;
      if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
    }
  }
  return false;
}

/// Corners next to one at the same place, and those from which the way leads straight back.
void PolygonCutter::dropSpikes() {
  for (bool again = true; again;) {
    again = false;
    for (std::size_t k = 0; k < ring_.size() && ring_.size() > 2;) {
      const bool drop = samePlace(ring_[k], corner(k + 1)) || samePlace(ring_[k], corner(k + 2));
      if (drop) ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>((k + 1) % ring_.size()));
      else ++k;
      again |= drop;
    }
  }
}

/// Whether nothing of the border lies in the ear at a corner. `strictly`: nor on its edges, so that no edge of a triangle runs over a corner.
bool PolygonCutter::mayCut(std::size_t at, bool strictly) const {
  const std::size_t n = ring_.size();
  const Corner a = corner(at + n - 1), b = ring_[at], c = corner(at + 1);
  const glm::dvec2 low = glm::min(glm::min(flat_[a], flat_[b]), flat_[c]) - noise_, high = glm::max(glm::max(flat_[a], flat_[b]), flat_[c]) + noise_;
  for (std::size_t k = at + 2; k + 1 < at + n; ++k) {
    const Corner v = corner(k);
    const glm::dvec2 p = flat_[v];
    if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) continue;
    const int ab = turn(a, b, v), bc = turn(b, c, v), ca = turn(c, a, v);
    if (ab < 0 || bc < 0 || ca < 0) continue;
    const bool atA = samePlace(v, a), atB = samePlace(v, b), atC = samePlace(v, c);
    const bool onEdge = ab == 0 || bc == 0 || ca == 0;
    if (!atA && !atB && !atC && (strictly || !onEdge)) return false;
    // The border comes by: it must not go on into the ear.
    for (const Corner w : {corner(k + n - 1), corner(k + 1)}) {
      const int wab = turn(a, b, w), wbc = turn(b, c, w), wca = turn(c, a, w);
      bool into = (ab != 0 || wab > 0) && (bc != 0 || wbc > 0) && (ca != 0 || wca > 0);
      if (atA) into = wab > 0 && wca > 0;
      else if (atB) into = wab > 0 && wbc > 0;
      else if (atC) into = wbc > 0 && wca > 0;
      if (into) return false;
    }
  }
  return true;
}

/// Twice an ear's area over its longest edge squared; negative where there is none.
double PolygonCutter::shapeOf(std::size_t at) const {
  const Corner a = corner(at + ring_.size() - 1), b = ring_[at], c = corner(at + 1);
  if (turn(a, b, c) <= 0) return -1.0;
  const glm::dvec2 ab = flat_[b] - flat_[a], bc = flat_[c] - flat_[b], ca = flat_[a] - flat_[c];
  return cross(ab, bc) / std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
}

bool PolygonCutter::cutBest(bool strictly, Triangles& triangles) {
  const std::size_t n = ring_.size();
  if (n < 3) return false;
  tried_.assign(n, 0);
  shape_.clear();
  for (std::size_t k = 0; k < n; ++k) shape_.push_back(shapeOf(k));
  for (std::size_t count = 0; count < n; ++count) {
    std::size_t best = n;
    for (std::size_t k = 0; k < n; ++k)
      if (!tried_[k] && shape_[k] > 0.0 && (best == n || shape_[k] > shape_[best])) best = k;
    if (best == n) return false;
    if (n == 3 || mayCut(best, strictly)) {
      triangles.push_back({corner(best + n - 1), ring_[best], corner(best + 1)});
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(best));
      return true;
    }
    tried_[best] = 1;
  }
  return false;
}

}  // namespace pitviper
