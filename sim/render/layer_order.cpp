#include "sim/render/layer_order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Pairs compared at most in a frame: about a tenth of a second.
constexpr std::size_t kMostPairs = 400000;
/// Two triangles that share an edge overlap by rounding only: areas below this part of a pixel don't count.
constexpr double kLeastOverlap_px2 = 1e-7;

/// Parts of the depth by which pieces may overlap and still only touch: meshes in single precision.
constexpr double kTouching = 1e-6;

using Polygon = std::vector<glm::dvec2>;

double twiceArea(const Polygon& p) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2 &a = p[i], &b = p[(i + 1) % p.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

/// A piece's footprint in the picture [pixels], counter-clockwise, and what is needed to tell how deep it is there.
struct Footprint {
  std::uint32_t piece = 0;
  Polygon outline;
  glm::dvec2 low{0.0}, high{0.0};
  double middle_m = 0.0;                   ///< range of its middle
  glm::dvec2 depths{INFINITY, -INFINITY};  ///< least and greatest [m]
  glm::dvec3 plane{0.0};                   ///< of a triangle: 1 / depth = plane . (tan x, tan y, -1)
};

/// What is left of a convex polygon on one side of the line from a to b.
Polygon clipped(const Polygon& p, const glm::dvec2& a, const glm::dvec2& b) {
  Polygon out;
  const glm::dvec2 e = b - a;
  auto side = [&](const glm::dvec2& q) { return e.x * (q.y - a.y) - e.y * (q.x - a.x); };
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2 &u = p[i], &v = p[(i + 1) % p.size()];
    const double su = side(u), sv = side(v);
    if (su >= 0.0) out.push_back(u);
    if ((su > 0.0 && sv < 0.0) || (su < 0.0 && sv > 0.0)) out.push_back(u + su / (su - sv) * (v - u));
  }
  return out;
}

/// What two outlines share, if it counts.
Polygon commonPart(const Footprint& a, const Footprint& b) {
  Polygon p = a.outline;
  for (std::size_t i = 0; i < b.outline.size() && p.size() > 2; ++i) p = clipped(p, b.outline[i], b.outline[(i + 1) % b.outline.size()]);
  if (p.size() < 3 || twiceArea(p) < 2.0 * kLeastOverlap_px2) return {};
  return p;
}

/// The outline around points of the film, counter-clockwise (Andrew's monotone chain).
Polygon hullOf(Polygon p) {
  std::sort(p.begin(), p.end(), [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  Polygon hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const glm::dvec2& q : p) {
      while (hull.size() >= first + 2) {
        const glm::dvec2 &u = hull[hull.size() - 2], &v = hull.back();
        if ((v.x - u.x) * (q.y - u.y) - (v.y - u.y) * (q.x - u.x) > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(q);
    }
    hull.pop_back();  // the other side begins with it
    std::reverse(p.begin(), p.end());
  }
  return hull;
}

class Sorter {
 public:
  Sorter(const View& view, const std::vector<LayerPiece>& pieces) : view_(view), pieces_(pieces) {
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      if (auto f = footprint(i)) prints_.push_back(std::move(*f));
    std::stable_sort(prints_.begin(), prints_.end(), [](const Footprint& a, const Footprint& b) { return a.middle_m > b.middle_m; });
  }

  LayerOrder run() {
    LayerOrder order;
    nearer_.resize(prints_.size());
    farther_.assign(prints_.size(), 0);
    order.exact = compareAll();
    order.crossing = crossing_;
    const std::vector<int> level = order.exact ? levels(order.cyclic) : std::vector<int>();
    std::vector<std::uint32_t> at(prints_.size());
    std::iota(at.begin(), at.end(), 0u);
    if (order.exact) std::stable_sort(at.begin(), at.end(), [&](std::uint32_t a, std::uint32_t b) { return level[a] < level[b]; });
    for (std::size_t k = 0; k < at.size(); ++k) {
      if (k == 0 || !order.exact || level[at[k]] != level[at[k - 1]]) order.levels.push_back(static_cast<std::uint32_t>(k));
      order.pieces.push_back(prints_[at[k]].piece);
    }
    order.levels.push_back(static_cast<std::uint32_t>(at.size()));
    return order;
  }

 private:
  glm::dvec2 onFilm(const glm::dvec3& p) const { return filmPosition(view_, p); }

  std::optional<Footprint> footprint(std::uint32_t index) const {
    const LayerPiece& piece = pieces_[index];
    Footprint f;
    f.piece = index;
    if (piece.medium) {
      const glm::dvec3 centre = piece.origin + piece.cameraFromBody * (0.5 * (piece.low + piece.high));
      f.middle_m = glm::length(centre);
      const glm::dvec2 end(view_.width, view_.height);
      for (int c = 0; c < 8; ++c) {
        const glm::dvec3 body((c & 1) ? piece.high.x : piece.low.x, (c & 2) ? piece.high.y : piece.low.y, (c & 4) ? piece.high.z : piece.low.z);
        const glm::dvec3 p = piece.origin + piece.cameraFromBody * body;
        f.depths = {std::min(f.depths.x, -p.z), std::max(f.depths.y, -p.z)};
        if (-p.z < view_.near_m) {  // the camera is inside, or nearly: it may fill the picture
          f.outline = {{0.0, 0.0}, {end.x, 0.0}, end, {0.0, end.y}};
          f.depths = {-INFINITY, INFINITY};
          break;
        }
        f.outline.push_back(onFilm(p));
      }
      f.outline = hullOf(f.outline);
    } else {
      // Cut at the near plane, then to the film.
      std::vector<glm::dvec3> in, cut;
      for (const auto& c : piece.corner) {
        in.push_back(c);
        f.depths = {std::min(f.depths.x, -c.z), std::max(f.depths.y, -c.z)};
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &u = in[i], &v = in[(i + 1) % 3];
        const double su = -u.z - view_.near_m, sv = -v.z - view_.near_m;
        if (su >= 0.0) cut.push_back(u);
        if ((su > 0.0 && sv < 0.0) || (su < 0.0 && sv > 0.0)) cut.push_back(u + su / (su - sv) * (v - u));
      }
      if (cut.size() < 3) return std::nullopt;
      const glm::dvec3 normal = glm::cross(in[1] - in[0], in[2] - in[0]);
      const double distance = glm::dot(normal, in[0]);
      if (distance == 0.0) return std::nullopt;  // seen on edge
      f.plane = normal / distance;
      f.middle_m = glm::length((in[0] + in[1] + in[2]) / 3.0);
      for (const auto& p : cut) f.outline.push_back(onFilm(p));
      if (twiceArea(f.outline) < 0.0) std::reverse(f.outline.begin(), f.outline.end());
    }
    const glm::dvec2 end(view_.width, view_.height);
    const Polygon film = {{0.0, 0.0}, {end.x, 0.0}, end, {0.0, end.y}};
    for (std::size_t i = 0; i < 4 && f.outline.size() > 2; ++i) f.outline = clipped(f.outline, film[i], film[(i + 1) % 4]);
    if (f.outline.size() < 3) return std::nullopt;
    f.low = f.high = f.outline[0];
    for (const auto& p : f.outline) f.low = glm::min(f.low, p), f.high = glm::max(f.high, p);
    return f;
  }

  /// Depth [m] of a piece on the line of sight through a film position, of a medium where its way begins and ends; nothing where it is not met.
  std::optional<glm::dvec2> depthAt(const Footprint& f, const glm::dvec2& at) const {
    const LayerPiece& piece = pieces_[f.piece];
    const glm::dvec3 ray = view_.ray(at.x, at.y);
    if (!piece.medium) return glm::dvec2(1.0 / glm::dot(f.plane, ray));
    const glm::dmat3 bodyFromCamera = glm::transpose(piece.cameraFromBody);
    const double near = -piece.origin.z;  // digits of the body's own size
    const glm::dvec3 d = bodyFromCamera * ray, o = bodyFromCamera * (near * ray - piece.origin);
    glm::dvec2 way(-INFINITY, INFINITY);
    if (piece.form.kind == BodyForm::Kind::Ellipsoid) way = physics::ellipsoidChord(o, d, piece.form.size);
    else if (piece.form.kind == BodyForm::Kind::Cone) way = physics::coneChord(o, d, piece.form.size.x, piece.form.size.y, piece.form.size.z);
    else
      for (int k = 0; k < 3; ++k) {
        if (d[k] == 0.0) continue;
        const double a = (piece.low[k] - o[k]) / d[k], b = (piece.high[k] - o[k]) / d[k];
        way = {std::max(way.x, std::min(a, b)), std::min(way.y, std::max(a, b))};
      }
    const double enter = std::max(near + way.x, 0.0), leave = near + way.y;
    return leave > enter ? std::optional(glm::dvec2(enter, leave)) : std::nullopt;
  }

  /// Where both are on a line of sight that meets both, if one of some does: the middle of what they share, else places spread over it.
  struct Depths {
    glm::dvec2 a, b;
  };
  std::optional<Depths> depthsOf(const Footprint& a, const Footprint& b, const Polygon& shared) const {
    auto both = [&](const glm::dvec2& at) -> std::optional<Depths> {
      const auto da = depthAt(a, at), db = depthAt(b, at);
      return da && db ? std::optional(Depths{*da, *db}) : std::nullopt;
    };
    std::optional<Depths> found;
    constexpr int kTries = 8;
    anywhere(shared, kTries, [&](const glm::dvec2& at) { return (found = both(at)).has_value(); });
    return found;
  }

  /// Visits the middle of an outline and places spread over it, so many along an edge of each triangle about the middle, until one is enough.
  template <class Visit>
  static bool anywhere(const Polygon& outline, int along, const Visit& visit) {
    glm::dvec2 middle(0.0);
    for (const auto& p : outline) middle += p / static_cast<double>(outline.size());
    if (visit(middle)) return true;
    for (std::size_t k = 0; k < outline.size(); ++k)
      for (int i = 1; i <= along; ++i)
        for (int j = 0; j <= along; ++j) {
          const glm::dvec2 edge = glm::mix(outline[k], outline[(k + 1) % outline.size()], (j + 0.5) / (along + 1));
          if (visit(glm::mix(middle, edge, (i - 0.5) / along))) return true;
        }
    return false;
  }

  /// Whether two pieces pass through each other: triangles that change sides within what they share, or ways that overlap somewhere in it.
  bool pass(const Footprint& a, const Footprint& b, const Polygon& shared) const {
    constexpr int kTries = 5;
    if (a.depths.x > b.depths.y || b.depths.x > a.depths.y) return false;
    if (pieces_[a.piece].medium || pieces_[b.piece].medium)
      return anywhere(shared, kTries, [&](const glm::dvec2& at) {
        const auto da = depthAt(a, at), db = depthAt(b, at);
        if (!da || !db) return false;
        const double slack = kTouching * std::max(da->y, db->y);
        return da->y - slack > db->x && db->y - slack > da->x;
      });
    double nearer = 0.0, farther = 0.0;  // of the first, by its depth
    for (const auto& at : shared) {
      const double za = 1.0 / glm::dot(a.plane, view_.ray(at.x, at.y)), zb = 1.0 / glm::dot(b.plane, view_.ray(at.x, at.y));
      nearer = std::max(nearer, (zb - za) / zb);
      farther = std::max(farther, (za - zb) / zb);
    }
    return nearer > kTouching && farther > kTouching;
  }

  void compare(std::uint32_t i, std::uint32_t j) {
    const Polygon shared = commonPart(prints_[i], prints_[j]);
    if (shared.empty()) return;
    const auto depths = depthsOf(prints_[i], prints_[j], shared);
    if (!depths) return;
    const bool crosses = pass(prints_[i], prints_[j], shared);
    crossing_ += crosses;
    // Of fields in each other what is brightest or thickest is about their origins: a nozzle, the newest of a trail.
    const LayerPiece &one = pieces_[prints_[i].piece], &other = pieces_[prints_[j].piece];
    const bool byOrigin = crosses && one.field >= 0 && other.field >= 0;
    const double a = byOrigin ? -one.origin.z : 0.5 * (depths->a.x + depths->a.y), b = byOrigin ? -other.origin.z : 0.5 * (depths->b.x + depths->b.y);
    // Rounding does not decide: what is equally deep is drawn in the order given.
    const bool equal = std::abs(a - b) <= 1e-13 * std::max(a, b);
    const bool first = equal ? prints_[i].piece < prints_[j].piece : a > b;
    nearer_[first ? i : j].push_back(first ? j : i);
    ++farther_[first ? j : i];
  }

  /// Every pair whose outlines' boxes touch, once, through a grid over the film. False where they are too many.
  bool compareAll() {
    if (prints_.size() < 2) return true;
    glm::dvec2 mean(0.0);
    for (const auto& f : prints_) mean += (f.high - f.low) / static_cast<double>(prints_.size());
    const glm::dvec2 film(view_.width, view_.height);
    glm::ivec2 cells;
    for (int k = 0; k < 2; ++k) cells[k] = static_cast<int>(std::clamp(film[k] / std::max(mean[k], 1e-9), 1.0, 128.0));
    auto cellOf = [&](const glm::dvec2& p) { return glm::clamp(glm::ivec2(p / film * glm::dvec2(cells)), glm::ivec2(0), cells - 1); };
    std::vector<std::vector<std::uint32_t>> grid(static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y));
    std::size_t pairs = 0;
    for (std::uint32_t i = 0; i < prints_.size(); ++i) {
      const glm::ivec2 from = cellOf(prints_[i].low), to = cellOf(prints_[i].high);
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
          auto& cell = grid[static_cast<std::size_t>(y * cells.x + x)];
          for (std::uint32_t j : cell) {
            const Footprint &a = prints_[i], &b = prints_[j];
            if (a.low.x > b.high.x || b.low.x > a.high.x || a.low.y > b.high.y || b.low.y > a.high.y) continue;
            if (cellOf(glm::max(a.low, b.low)) != glm::ivec2(x, y)) continue;  // another cell's pair
            if (++pairs > kMostPairs) return false;
            compare(j, i);
          }
          cell.push_back(i);
        }
    }
    return true;
  }

  /// One more than that of the highest piece behind.
  std::vector<int> levels(int& cyclic) const {
    std::vector<int> level(prints_.size(), 0), waiting = farther_;
    std::vector<char> done(prints_.size(), 0);
    std::vector<std::uint32_t> ready;
    for (std::uint32_t i = 0; i < prints_.size(); ++i)
      if (waiting[i] == 0) ready.push_back(i);
    int highest = 0;
    std::uint32_t next = 0;
    for (std::size_t count = 0; count < prints_.size(); ++count) {
      if (ready.empty()) {  // a ring: its farthest middle goes first
        while (done[next]) ++next;
        level[next] = highest + 1;
        ready.push_back(next);
        ++cyclic;
      }
      const std::uint32_t i = ready.back();
      ready.pop_back();
      done[i] = 1;
      highest = std::max(highest, level[i]);
      for (std::uint32_t j : nearer_[i]) {
        if (done[j]) continue;
        level[j] = std::max(level[j], level[i] + 1);
        if (--waiting[j] == 0) ready.push_back(j);
      }
    }
    return level;
  }

  const View& view_;
  const std::vector<LayerPiece>& pieces_;
  std::vector<Footprint> prints_;
  std::vector<std::vector<std::uint32_t>> nearer_;  ///< overlapping pieces in front of each
  int crossing_ = 0;
  std::vector<int> farther_;  ///< how many are behind
};

}  // namespace

void OrderFaults::add(const OrderFaults& v) {
  exact = exact && v.exact;
  crossing = std::max(crossing, v.crossing);
  cyclic = std::max(cyclic, v.cyclic);
}

std::string OrderFaults::describe() const {
  if (!exact) return "by middles";
  auto count = [](int n, const char* what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); };
  std::string but;
  if (crossing > 0) but = count(crossing, "pair") + " that " + (crossing == 1 ? "passes" : "pass") + " through each other";
  if (cyclic > 0) but += (but.empty() ? "" : " and ") + count(cyclic, "piece") + " in rings";
  return but.empty() ? "exact" : "exact but for " + but;
}

LayerOrder orderLayers(const View& view, const std::vector<LayerPiece>& pieces) { return Sorter(view, pieces).run(); }

}  // namespace pitviper
