#include "sim/model/clear_facets.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <future>
#include <thread>

namespace pitviper {
namespace {

/// A triangle as the light sees it: corners counter-clockwise, how near they come to it.
struct Seen {
  std::array<glm::dvec2, 3> corner;
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

std::vector<Seen> seenFrom(const Mesh& mesh, const glm::dvec3& toLight) {
  const glm::dvec3 u = glm::normalize(glm::cross(toLight, std::abs(toLight.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))), v = glm::cross(toLight, u);
  std::vector<Seen> all;
  all.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) {
    Seen s;
    s.low = glm::dvec2(INFINITY), s.high = glm::dvec2(-INFINITY), s.nearest = -INFINITY, s.farthest = INFINITY;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p(mesh.positions[t[k]]);
      const glm::dvec2 at(glm::dot(p, u), glm::dot(p, v));
      const double along = glm::dot(p, toLight);
      s.corner[static_cast<size_t>(k)] = at;
      s.low = glm::min(s.low, at), s.high = glm::max(s.high, at);
      s.nearest = std::max(s.nearest, along), s.farthest = std::min(s.farthest, along);
    }
    s.faces = turn(s.corner[0], s.corner[1], s.corner[2]) > 0.0;
    if (!s.faces) std::swap(s.corner[1], s.corner[2]);
    all.push_back(s);
  }
  return all;
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
      clear = outsideAnEdge(own, other) || outsideAnEdge(other, own);
    }
  });
  return clear;
}

}  // namespace

std::vector<char> clearFacets(const Mesh& mesh, const glm::dvec3& toLight) {
  const std::vector<Seen> all = seenFrom(mesh, toLight);
  std::vector<char> clear(all.size(), 0);
  if (all.empty()) return clear;
  const Cells cells(all);
  if (!cells.affordable()) return clear;
  constexpr size_t kEach = 4096;
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t first = next.fetch_add(kEach); first < all.size(); first = next.fetch_add(kEach))
      for (size_t n = first; n < std::min(first + kEach, all.size()); ++n) clear[n] = isClear(all, cells, n);
  };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& o : others) o.get();
  return clear;
}

}  // namespace pitviper
