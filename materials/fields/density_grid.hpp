#pragma once
// A number on a regular grid of nodes, trilinear between them, 0 outside its box.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace pitviper {

struct DensityGrid {
  glm::ivec3 nodes{0};
  glm::dvec3 first{0.0}, spacing{1.0};  ///< place of the first node and what lies between [m]
  std::vector<float> value;             ///< x fastest

  DensityGrid() = default;
  DensityGrid(const glm::ivec3& n, const glm::dvec3& at, const glm::dvec3& apart)
      : nodes(n), first(at), spacing(apart), value(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z), 0.0f) {}

  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(nodes.y) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(nodes.x) +
           static_cast<std::size_t>(i);
  }
  glm::dvec3 place(int i, int j, int k) const { return first + glm::dvec3(i, j, k) * spacing; }
  glm::dvec3 last() const { return place(nodes.x - 1, nodes.y - 1, nodes.z - 1); }

  double at(const glm::dvec3& p) const {
    const glm::dvec3 u = (p - first) / spacing;
    if (!(u.x >= 0.0 && u.y >= 0.0 && u.z >= 0.0 && u.x <= nodes.x - 1 && u.y <= nodes.y - 1 && u.z <= nodes.z - 1)) return 0.0;
    const glm::ivec3 c = glm::min(glm::ivec3(u), nodes - 2);
    const glm::dvec3 part = u - glm::dvec3(c);
    const float* v = value.data() + index(c.x, c.y, c.z);
    const std::size_t y = static_cast<std::size_t>(nodes.x), z = y * static_cast<std::size_t>(nodes.y);
    const auto row = [&](std::size_t n) { return v[n] + part.x * (v[n + 1] - v[n]); };
    const double low = row(0) + part.y * (row(y) - row(0)), high = row(z) + part.y * (row(y + z) - row(z));
    return low + part.z * (high - low);
  }

  /// Where p + t d, t >= 0, is within the box; empty (x >= y) where it misses.
  glm::dvec2 chord(const glm::dvec3& p, const glm::dvec3& d) const {
    glm::dvec2 t(0.0, 1e30);
    const glm::dvec3 high = last();
    for (int a = 0; a < 3; ++a) {
      if (std::abs(d[a]) < 1e-12) {
        if (p[a] < first[a] || p[a] > high[a]) return {0.0, 0.0};
        continue;
      }
      const double one = (first[a] - p[a]) / d[a], other = (high[a] - p[a]) / d[a];
      t = {std::max(t.x, std::min(one, other)), std::min(t.y, std::max(one, other))};
    }
    return t;
  }

  /// Integral from p along d (a unit vector) to the border of the box: middles of steps of `step` times the least spacing.
  double along(const glm::dvec3& p, const glm::dvec3& d, double step = 0.5) const {
    const glm::dvec2 t = chord(p, d);
    if (!(t.y > t.x)) return 0.0;
    const int count = std::max(1, static_cast<int>(std::ceil((t.y - t.x) / (step * std::min({spacing.x, spacing.y, spacing.z})))));
    const double each = (t.y - t.x) / count;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) sum += at(p + d * (t.x + (i + 0.5) * each));
    return sum * each;
  }
};

}  // namespace pitviper
