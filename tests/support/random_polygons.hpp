#pragma once
// Polygons as files have them at their worst, and what area they have.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>
#include <vector>

namespace pitviper::test {

class RandomPolygon {
 public:
  explicit RandomPolygon(std::uint64_t seed) : random_(seed) {
    if (toss(0.3)) makeComb();
    else makeStar();
    if (toss(0.5)) addHoles(1 + static_cast<int>(random_() % 3));
    if (toss(0.6)) addOnLines();
    if (toss(0.5)) addSpike();
    if (toss(0.6)) addTwice();
    const std::size_t begin = random_() % ring_.size();
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(begin), ring_.end());
    if (toss(0.5)) std::reverse(ring_.begin(), ring_.end());
    turn();
  }

  const std::vector<glm::dvec3>& corners() const { return corners_; }
  /// By the shoelace formula (Gauss) over the plane that it was made in.
  double area() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const glm::dvec2 a = ring_[k], b = ring_[(k + 1) % ring_.size()];
      sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return std::abs(sum);
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  bool toss(double share) { return unit() < share; }
  static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

  void makeStar() {
    const int n = 3 + static_cast<int>(random_() % 30);
    const double least = toss(0.5) ? 0.9 : 0.35;
    for (int k = 0; k < n; ++k) {
      const double a = 2.0 * std::numbers::pi * (k + 0.6 * unit()) / n, r = 3.0 * (least + (1.0 - least) * unit());
      ring_.emplace_back(r * std::cos(a), r * std::sin(a));
    }
  }

  /// Teeth on a bar; some touch the next, at a corner or along an edge. On a lattice: many corners lie on one line.
  void makeComb() {
    const int teeth = 1 + static_cast<int>(random_() % 6);
    ring_ = {{0.0, 0.0}, {2.0 * teeth, 0.0}, {2.0 * teeth, 1.0}};
    for (int k = teeth - 1; k >= 0; --k) {
      const double x = 2.0 * k, h = 1.0 + static_cast<double>(random_() % 4), wide = k + 1 < teeth && toss(0.5) ? 2.0 : 1.0;
      for (const glm::dvec2 p : {glm::dvec2(x + 1.0, 1.0), {x + wide, 1.0 + 0.5 * h}, {x + wide, 1.0 + h}, {x, 1.0 + h}, {x, 1.0}}) ring_.push_back(p);
    }
    mayHaveHoles_ = false;
  }

  bool isClear(const glm::dvec2& a, const glm::dvec2& b) const {
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const glm::dvec2 c = ring_[k], d = ring_[(k + 1) % ring_.size()];
      if (c == a || c == b || d == a || d == b) continue;
      if (cross(b - a, c - a) * cross(b - a, d - a) <= 0.0 && cross(d - c, a - c) * cross(d - c, b - c) <= 0.0) return false;
    }
    return true;
  }

  /// Small stars about the middle, each joined to the border by a bridge there and back.
  void addHoles(int count) {
    if (!mayHaveHoles_) return;
    for (int h = 0; h < count; ++h) {
      const double at = 2.0 * std::numbers::pi * (h + 0.2 * unit()) / count;
      const glm::dvec2 middle = count == 1 ? glm::dvec2(0.0) : 0.55 * glm::dvec2(std::cos(at), std::sin(at));
      std::vector<glm::dvec2> hole;
      const int n = 3 + static_cast<int>(random_() % 6);
      for (int k = 0; k < n; ++k) {
        const double a = -2.0 * std::numbers::pi * (k + 0.5 * unit()) / n, r = 0.15 + 0.15 * unit();
        hole.push_back(middle + r * glm::dvec2(std::cos(a), std::sin(a)));
      }
      if (!bridgeTo(hole)) return;
    }
  }

  /// Turns about a place [turns].
  static double windingAbout(const glm::dvec2& place, const std::vector<glm::dvec2>& ring) {
    double sum = 0.0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const glm::dvec2 c = ring[k] - place, d = ring[(k + 1) % ring.size()] - place;
      sum += std::atan2(cross(c, d), glm::dot(c, d));
    }
    return sum / (2.0 * std::numbers::pi);
  }

  bool bridgeTo(const std::vector<glm::dvec2>& hole) {
    for (std::size_t k = 0; k < hole.size(); ++k)
      if (!isClear(hole[k], hole[(k + 1) % hole.size()]) || std::abs(windingAbout(hole[k], ring_) - 1.0) > 0.1) return false;
    for (int tries = 0; tries < 200; ++tries) {
      const std::size_t from = random_() % ring_.size(), to = random_() % hole.size();
      const glm::dvec2 a = ring_[from], b = hole[to];
      // Into the polygon, out of the hole, across nothing.
      const glm::dvec2 before = ring_[(from + ring_.size() - 1) % ring_.size()], after = ring_[(from + 1) % ring_.size()];
      const bool convex = cross(after - a, before - a) > 0.0;
      const bool left = cross(after - a, b - a) > 1e-3, right = cross(b - a, before - a) > 1e-3;
      if (!(convex ? left && right : left || right) || !isClear(a, b)) continue;
      bool clear = true;
      for (std::size_t k = 0; k < hole.size(); ++k) {
        const glm::dvec2 c = hole[k], d = hole[(k + 1) % hole.size()];
        if (c != b && d != b && cross(b - a, c - a) * cross(b - a, d - a) <= 0.0 && cross(d - c, a - c) * cross(d - c, b - c) <= 0.0) clear = false;
      }
      if (!clear || std::abs(windingAbout(a + (b - a) * (1.0 - 1e-6), hole)) > 0.1) continue;  // the bridge's end lies outside of the hole
      std::vector<glm::dvec2> way;
      for (std::size_t k = 0; k <= hole.size(); ++k) way.push_back(hole[(to + k) % hole.size()]);
      way.push_back(a);
      ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(from) + 1, way.begin(), way.end());
      return true;
    }
    return false;
  }

  /// Corners in the middles of edges.
  void addOnLines() {
    for (int k = 0, n = 1 + static_cast<int>(random_() % 6); k < n; ++k) {
      const std::size_t at = random_() % ring_.size();
      const glm::dvec2 a = ring_[at], b = ring_[(at + 1) % ring_.size()];
      ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(at) + 1, a + (b - a) * (0.25 * static_cast<double>(1 + random_() % 3)));
    }
  }

  /// Out along an edge's direction and straight back.
  void addSpike() {
    const std::size_t at = random_() % ring_.size();
    const glm::dvec2 a = ring_[at], b = ring_[(at + 1) % ring_.size()];
    if (a == b) return;
    const auto here = ring_.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    ring_.insert(here, {0.5 * (a + b), a});
  }

  /// Corners written twice, or three times, in a row.
  void addTwice() {
    for (int k = 0, n = 1 + static_cast<int>(random_() % 3); k < n; ++k) {
      const std::size_t at = random_() % ring_.size();
      ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(at), 1 + random_() % 2, ring_[at]);
    }
  }

  void turn() {
    const glm::dvec3 axis = toss(0.2) ? glm::dvec3(0, 0, 1) : glm::normalize(glm::dvec3(unit() - 0.5, unit() - 0.5, unit() - 0.5));
    const glm::dvec3 u = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))), v = glm::cross(axis, u);
    for (const glm::dvec2& p : ring_) corners_.push_back(p.x * u + p.y * v);
  }

  std::mt19937_64 random_;
  bool mayHaveHoles_ = true;
  std::vector<glm::dvec2> ring_;
  std::vector<glm::dvec3> corners_;
};

}  // namespace pitviper::test
