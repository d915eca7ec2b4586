#include "sim/world/clear_facets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "sim/parameters/fingerprint.hpp"
#include "sim/parameters/on_threads.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

/// A triangle as the light sees it: corners counter-clockwise, how near they come to it.
struct Seen {
  std::array<glm::dvec2, 3> corner;
  std::array<double, 3> height;  ///< of the corners, along the way to the light
  glm::dvec2 low, high;
  double nearest = 0.0, farthest = 0.0;  ///< along the way to the light
  bool faces = false;
};

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// All corners of b lie on an edge of a or outside it.
bool outsideAnEdge(const Seen& a, const Seen& b) {
  for (size_t k = 0; k < 3; ++k) {
    const glm::dvec2 &from = a.corner[k], &to = a.corner[(k + 1) % 3];
    if (std::all_of(b.corner.begin(), b.corner.end(), [&](const glm::dvec2& c) { return turn(from, to, c) <= 0.0; })) return true;
  }
  return false;
}

/// How far a corner of b lies above the plane of a (sign), in units of a's area.
double above(const Seen& a, const Seen& b, size_t corner) {
  const glm::dvec2 &p = b.corner[corner], &o = a.corner[0];
  const double area = turn(o, a.corner[1], a.corner[2]), x = turn(o, p, a.corner[2]), y = turn(o, a.corner[1], p);
  return (b.height[corner] - a.height[0]) * area - x * (a.height[1] - a.height[0]) - y * (a.height[2] - a.height[0]);
}

/// Whether the plane of one of them parts them so that b is nowhere nearer to the light. Rounding is a corner of itself: what touches does not count.
bool liesBehind(const Seen& b, const Seen& a) {
  constexpr double kRounding = 1e-12;
  const auto room = [](const Seen& plane, const Seen& other) {
    const double reach = std::max({std::abs(plane.nearest), std::abs(plane.farthest), std::abs(other.nearest), std::abs(other.farthest)});
    return kRounding * reach * turn(plane.corner[0], plane.corner[1], plane.corner[2]);
  };
  bool under = true, over = true;
  for (size_t k = 0; k < 3; ++k) {
    under = under && above(a, b, k) <= room(a, b);
    over = over && above(b, a, k) >= -room(b, a);
  }
  return under || over;
}

void addSeen(const Occluder& body, const glm::dvec3& toLight, std::vector<Seen>& all) {
  const glm::dvec3 u = glm::normalize(glm::cross(toLight, std::abs(toLight.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))), v = glm::cross(toLight, u);
  all.reserve(all.size() + body.mesh.triangles.size());
  for (const glm::uvec3& t : body.mesh.triangles) {
    Seen s;
    s.low = glm::dvec2(INFINITY), s.high = glm::dvec2(-INFINITY), s.nearest = -INFINITY, s.farthest = INFINITY;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p = body.axes * glm::dvec3(body.mesh.positions[t[k]]) + body.origin;
      const glm::dvec2 at(glm::dot(p, u), glm::dot(p, v));
      const double along = glm::dot(p, toLight);
      s.corner[static_cast<size_t>(k)] = at;
      s.height[static_cast<size_t>(k)] = along;
      s.low = glm::min(s.low, at), s.high = glm::max(s.high, at);
      s.nearest = std::max(s.nearest, along), s.farthest = std::min(s.farthest, along);
    }
    s.faces = turn(s.corner[0], s.corner[1], s.corner[2]) > 0.0;
    if (!s.faces) std::swap(s.corner[1], s.corner[2]), std::swap(s.height[1], s.height[2]);
    all.push_back(s);
  }
}

/// So many pairs of triangles are looked at, at most: a second or so.
constexpr double kMostPairs = 4e8;

/// Triangles by square cells of the light's view, about as many as triangles.
class Cells {
 public:
  explicit Cells(const std::vector<Seen>& all) {
    low_ = glm::dvec2(INFINITY);
    glm::dvec2 high(-INFINITY);
    for (const Seen& s : all) low_ = glm::min(low_, s.low), high = glm::max(high, s.high);
    across_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(all.size()))), 1, 4096);
    each_ = glm::max((high - low_) / static_cast<double>(across_), glm::dvec2(1e-300));
    // Long triangles side by side lie over each other's cells by the thousand, and a cell may hold nearly all of them.
    double entries = 0.0;
    for (const Seen& s : all) {
      const glm::dvec2 size = glm::dvec2(cellOf(s.high) - cellOf(s.low)) + 1.0;
      entries += size.x * size.y;
    }
    if (entries > kMostPairs / 16.0) return;
    first_.assign(static_cast<size_t>(across_ * across_) + 1, 0);
    for (const Seen& s : all) eachCell(s, [&](size_t c) { ++first_[c + 1]; });
    double pairs = 0.0;
    for (std::uint32_t members : first_) pairs += static_cast<double>(members) * members;
    if (pairs > kMostPairs) return;
    affordable_ = true;
    for (size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    members_.resize(first_.back());
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (size_t n = 0; n < all.size(); ++n) eachCell(all[n], [&](size_t c) { members_[at[c]++] = static_cast<std::uint32_t>(n); });
  }
  template <class Visit>
  void eachCell(const Seen& s, const Visit& visit) const {
    const glm::ivec2 a = cellOf(s.low), b = cellOf(s.high);
    for (int y = a.y; y <= b.y; ++y)
      for (int x = a.x; x <= b.x; ++x) visit(static_cast<size_t>(y * across_ + x));
  }
  /// False: there would be too much to look at.
  bool affordable() const { return affordable_; }
  const std::uint32_t* begin(size_t cell) const { return members_.data() + first_[cell]; }
  const std::uint32_t* end(size_t cell) const { return members_.data() + first_[cell + 1]; }

 private:
  glm::ivec2 cellOf(const glm::dvec2& p) const { return glm::clamp(glm::ivec2((p - low_) / each_), glm::ivec2(0), glm::ivec2(across_ - 1)); }
  int across_ = 1;
  bool affordable_ = false;
  glm::dvec2 low_, each_;
  std::vector<std::uint32_t> first_, members_;
};

bool isClear(const std::vector<Seen>& all, const Cells& cells, size_t number) {
  const Seen& own = all[number];
  if (!own.faces) return false;
  bool clear = true;
  cells.eachCell(own, [&](size_t cell) {
    for (const std::uint32_t* n = cells.begin(cell); clear && n != cells.end(cell); ++n) {
      const Seen& other = all[*n];
      if (*n == number || !(other.nearest > own.farthest)) continue;
      if (other.low.x >= own.high.x || other.high.x <= own.low.x || other.low.y >= own.high.y || other.high.y <= own.low.y) continue;
      clear = outsideAnEdge(own, other) || outsideAnEdge(other, own) || liesBehind(other, own);
    }
  });
  return clear;
}

}  // namespace

std::vector<char> clearFacets(const Mesh& mesh, const glm::dvec3& toLight, std::span<const Occluder> others) {
  std::vector<Seen> all;
  addSeen({mesh}, toLight, all);
  const size_t own = all.size();
  std::vector<char> clear(own, 0);
  if (all.empty()) return clear;
  Seen whole = all.front();
  for (const Seen& s : all) {
    whole.low = glm::min(whole.low, s.low), whole.high = glm::max(whole.high, s.high);
    whole.farthest = std::min(whole.farthest, s.farthest);
  }
  for (const Occluder& o : others) {
    std::vector<Seen> theirs;
    addSeen(o, toLight, theirs);
    // What lies beside all of the mesh or behind it shades none of it.
    std::copy_if(theirs.begin(), theirs.end(), std::back_inserter(all), [&](const Seen& s) {
      return s.nearest > whole.farthest && s.low.x < whole.high.x && s.high.x > whole.low.x && s.low.y < whole.high.y && s.high.y > whole.low.y;
    });
  }
  const Cells cells(all);
  if (!cells.affordable()) return clear;
  constexpr size_t kEach = 4096;
  onAllThreads((own + kEach - 1) / kEach, [&](const auto& next) {
    for (size_t first = next() * kEach; first < own; first = next() * kEach)
      for (size_t n = first; n < std::min(first + kEach, own); ++n) clear[n] = isClear(all, cells, n);
  });
  return clear;
}

std::vector<char> keptClearFacets(const Mesh& mesh, const glm::dvec3& toLight, std::span<const Occluder> others) {
  constexpr const char* kWhat = "clear";
  const ContentKey key = contentKeyOf([&](Fingerprint& f) {
    f.add(toLight).all(mesh.positions).all(mesh.triangles);
    for (const Occluder& o : others) {
      for (int k = 0; k < 3; ++k) f.add(o.axes[k]);
      f.add(o.origin).all(o.mesh.positions).all(o.mesh.triangles);
    }
  });
  if (const auto kept = readCachedTable(kWhat, key)) {
    TableReader in(*kept);
    std::vector<char> clear = in.all<char>();
    if (in.isWhole() && clear.size() == mesh.triangles.size()) return clear;
  }
  std::vector<char> clear = clearFacets(mesh, toLight, others);
  TableWriter out;
  out.all(clear);
  writeCachedTable(kWhat, key, out.bytes());
  return clear;
}

}  // namespace pitviper
