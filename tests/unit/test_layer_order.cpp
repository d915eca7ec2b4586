// Chords of bodies against sampling, and the order of transparent pieces against depths along random rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/radiometry/physics.hpp"
#include "sim/render/layer_order.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/ray_march.hpp"

namespace pitviper::test {
namespace {

constexpr double kPi = std::numbers::pi;

// --- chords ---------------------------------------------------------------------------------------------------------------------------

/// Length inside by counting: 20000 points along the line.
double sampled(const Gauge& gauge, const Line& line, double reach) {
  const int n = 20000;
  int inside = 0;
  for (int i = 0; i < n; ++i) inside += gauge(line.at((2.0 * (i + 0.5) / n - 1.0) * reach)) < 0.0 ? 1 : 0;
  return 2.0 * reach * inside / n;
}

struct Rays {
  std::mt19937 random{11};
  std::uniform_real_distribution<double> unit{-1.0, 1.0};
  glm::dvec3 point(double size) { return size * glm::dvec3(unit(random), unit(random), unit(random)); }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 d = point(1.0);
      if (const double l = glm::length(d); l > 0.1 && l < 1.0) return d / l;
    }
  }
  /// Towards the body, from a place a few sizes off.
  Line towards(double size) {
    const glm::dvec3 d = direction();
    return {point(size) - 3.0 * size * d, d};
  }
};

/// Worst difference of a chord's ends [in sizes] over lines that don't graze; grazing ones only have to be short.
template <typename Chord>
void compare(const std::string& what, const Gauge& gauge, double size, double reach, const std::vector<Line>& lines, const Chord& chord) {
  double worst = 0.0, worstSampled = 0.0;
  int hits = 0;
  for (size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    const double centre = -glm::dot(line.origin, line.direction);
    const Stretch want = chordOf(gauge, line, centre - reach, centre + reach);
    // Not of unit length in the program: its rays have z = -1 in the camera.
    const double scale = 1.0 + 0.25 * static_cast<double>(i % 4);
    const auto got = chord(line.origin, line.direction * scale);
    const double length = std::max(got.y - got.x, 0.0) * scale;
    EXPECT_TRUE(std::isfinite(length)) << what;
    worst = std::max(worst, std::abs(length - want.length()) / size);
    if (want.length() > 0.05 * size) {
      ++hits;
      worst = std::max({worst, std::abs(got.x * scale - want.enter) / size, std::abs(got.y * scale - want.leave) / size});
    }
    if (i % 50 == 0) worstSampled = std::max(worstSampled, std::abs(length - sampled(gauge, {line.at(centre), line.direction}, reach)) / size);
  }
  EXPECT_GT(hits, static_cast<int>(lines.size()) / 100) << what;
  // A chord of length l has its ends where the gauge falls by l^2: 1e-12 of it, at which the search stops, hides chords of 1e-6.
  bound(what + ", against bisection [sizes]", worst, 4e-6, "chords shorter than this are hidden by the search for their middle");
  bound(what + ", against counting [sizes]", worstSampled, 2.5 * 2.0 * reach / size / 20000.0, "two ends, a sample each");
}

std::vector<Line> randomLines(double size, int count) {
  Rays rays;
  std::vector<Line> lines;
  for (int i = 0; i < count; ++i) lines.push_back(rays.towards(size));
  return lines;
}

TEST(Chords, EllipsoidsAgainstBisectionAndCounting) {
  for (const glm::dvec3 s : {glm::dvec3(1, 1, 1), glm::dvec3(2, 1, 0.3), glm::dvec3(0.05, 1, 1), glm::dvec3(5, 0.2, 0.2)}) {
    const double size = std::max({s.x, s.y, s.z});
    auto lines = randomLines(size, 2000);
    for (int k = 0; k < 3; ++k) {  // along the axes, through the middle and beside it
      glm::dvec3 d(0.0);
      d[k] = 1.0;
      lines.push_back({-3.0 * size * d, d});
      lines.push_back({-3.0 * size * d + 0.3 * glm::dvec3(s.y, s.z, s.x) * glm::dvec3(k != 0, k != 1, k != 2), d});
    }
    compare("ellipsoid " + text(s.x) + " x " + text(s.y) + " x " + text(s.z), ellipsoidGauge(s), size, 3.0 * size, lines,
            [&](const glm::dvec3& p, const glm::dvec3& d) { return physics::ellipsoidChord(p, d, s); });
  }
  // Tangents, and past by a hair.
  for (double off : {1.0, 1.0 + 1e-12, 1.5}) {
    const auto c = physics::ellipsoidChord({-5, off, 0}, {1, 0, 0}, {1, 1, 1});
    EXPECT_EQ(c.x, c.y) << off;
  }
  const auto shallow = physics::ellipsoidChord({-5, 1.0 - 1e-8, 0}, {1, 0, 0}, {1, 1, 1});
  figure("chord of a sphere 1e-8 below its top", shallow.y - shallow.x, 2.0 * std::sqrt(2e-8), 1e-7, "2 sqrt(1 - y2)");
}

TEST(Chords, ConesAgainstBisectionAndCounting) {
  struct Form {
    double half, base, top;
  };
  for (const Form f : {Form{1, 1, 1}, Form{1, 1, 0}, Form{1, 0, 1}, Form{2, 1, 0.3}, Form{0.2, 2, 0.1}, Form{3, 0.1, 0.4}, Form{0.05, 1, 1}}) {
    const double size = std::max({f.half, f.base, f.top}), slope = 0.5 * (f.top - f.base) / f.half, middle = 0.5 * (f.top + f.base);
    auto lines = randomLines(size, 2000);
    Rays rays;
    for (int i = 0; i < 400 && slope != 0.0; ++i) {
      const double turn = kPi * rays.unit(rays.random), c = std::cos(turn), s = std::sin(turn), x = 0.9 * f.half * rays.unit(rays.random);
      const glm::dvec3 side = glm::normalize(glm::dvec3(1.0, slope * c, slope * s));  // along the surface: the square term is 0
      const double inwards = 0.7 * middle * std::abs(rays.unit(rays.random));
      lines.push_back({glm::dvec3(0.0, (middle - inwards) * c, (middle - inwards) * s) - 4.0 * size * side, side});   // parallel to a side, inside
      lines.push_back({glm::dvec3(0.0, (middle - inwards) * c, (middle - inwards) * s) + 4.0 * size * side, -side});  // the other way
      lines.push_back({glm::dvec3(x, 0.5 * middle * c, 0.5 * middle * s) + 4.0 * size * glm::dvec3(0, c, s), glm::dvec3(0, -c, -s)});  // across
      const glm::dvec3 tip(-middle / slope, 0, 0), d = rays.direction();
      lines.push_back({tip - 4.0 * size * d, d});  // through the tip
    }
    compare("cone of half length " + text(f.half) + ", radii " + text(f.base) + " and " + text(f.top), frustumGauge(f.half, f.base, f.top), size,
            6.0 * size + std::abs(slope != 0.0 ? middle / slope : 0.0), lines,
            [&](const glm::dvec3& p, const glm::dvec3& d) { return physics::coneChord(p, d, f.half, f.base, f.top); });
  }
}

TEST(Chords, ConesInDegenerateDirections) {
  auto length = [](const glm::dvec3& p, const glm::dvec3& d, double half, double base, double top) {
    const auto c = physics::coneChord(p, d, half, base, top);
    return std::max(c.y - c.x, 0.0) * glm::length(d);
  };
  // Along the axis of a cone: ends at the side, or at the flat end.
  figure("along the axis of a cone", length({-9, 0, 0}, {1, 0, 0}, 1, 1, 0), 2.0, 1e-12, "whole length");
  figure("parallel to the axis of a cone, off by 0.25", length({-9, 0.25, 0}, {1, 0, 0}, 1, 1, 0), 1.5, 1e-12, "2 (1 - y)");
  figure("against the axis of a frustum, off by 0.75", length({9, 0, 0.75}, {-2, 0, 0}, 1, 1, 0.5), 1.0, 1e-12, "2 (1 - z)/(1 - 0.5)");
  figure("parallel to the axis of a cone, outside", length({-9, 1.25, 0}, {1, 0, 0}, 1, 1, 0), 0.0, 0.0, "misses");
  figure("across a cylinder beyond its end", length({1.5, -9, 0}, {0, 1, 0}, 1, 1, 1), 0.0, 0.0, "misses");
  figure("across a cylinder at its middle", length({0, -9, 0.6}, {0, 1, 0}, 1, 1, 1), 1.6, 1e-12, "2 sqrt(1 - z2)");
  figure("through a cone's tip, across", length({1, -9, 0}, {0, 1, 0}, 1, 1, 0), 0.0, 1e-12, "a point");
  figure("along the side of a cone", length(glm::dvec3(-9, 5, 0), glm::dvec3(2, -1, 0), 1, 1, 0), 0.0, 1e-6, "touches");
  figure("along the side of a cylinder", length({-9, 1, 0}, {1, 0, 0}, 1, 1, 1), 0.0, 0.0, "touches");
  figure("tangent to a cylinder", length({0, -9, 1}, {0, 1, 0}, 1, 1, 1), 0.0, 0.0, "touches");
  // Nearly parallel: down to where the square term is lost.
  for (double tilt : {1e-3, 1e-8, 1e-12, 1e-15, 1e-16, 1e-20}) {
    figure("cylinder at " + text(tilt) + " from its axis", length({-9, 0.5, 0}, {1, tilt, 0}, 1, 1, 1), 2.0 * std::sqrt(1.0 + tilt * tilt), 1e-9,
           "from end to end");
    figure("cone at " + text(tilt) + " from its side", length({-9, 4.5, 0}, {2, -1 + tilt, 0}, 1, 1, 0), length({-9, 4.5, 0}, {2, -1, 0}, 1, 1, 0),
           3.0 * tilt + 1e-9, "next to that parallel to the side");
  }
  figure("parallel to a cone's side, half way in", length({-9, 4.5, 0}, {2, -1, 0}, 1, 1, 0), std::sqrt(5.0) * 0.75, 1e-9,
         "from the base at y = 0.5 to the other side at x = 0.5");
}

// --- order ------------------------------------------------------------------------------------------------------------------------------

View viewOf(int pixels, double tangent) {
  View v;
  v.width = v.height = pixels;
  v.tanPerPixelX = v.tanPerPixelY = 2.0 * tangent / pixels;
  v.axisX = v.axisY = 0.5 * pixels;
  return v;
}

/// Depth at which a ray meets a triangle's plane, and whether within its outline (shrunk by `margin` of barycentric weight).
std::optional<double> depthOf(const LayerPiece& p, const glm::dvec3& ray, double margin) {
  const glm::dvec3 e1 = p.corner[1] - p.corner[0], e2 = p.corner[2] - p.corner[0], q = glm::cross(ray, e2), s = -p.corner[0], r = glm::cross(s, e1);
  const double det = glm::dot(e1, q);
  if (det == 0.0) return std::nullopt;
  const double v = glm::dot(s, q) / det, w = glm::dot(ray, r) / det, t = glm::dot(e2, r) / det;
  if (v < margin || w < margin || v + w > 1.0 - margin || t <= 0.0) return std::nullopt;
  return t;
}

/// Where each piece comes in the order, or -1; and its level.
struct Places {
  std::vector<int> place, level;
  Places(const LayerOrder& order, size_t pieces) : place(pieces, -1), level(pieces, -1) {
    for (size_t l = 0; l + 1 < order.levels.size(); ++l)
      for (auto i = order.levels[l]; i < order.levels[l + 1]; ++i) {
        EXPECT_EQ(place[order.pieces[i]], -1) << "twice";
        place[order.pieces[i]] = static_cast<int>(i);
        level[order.pieces[i]] = static_cast<int>(l);
      }
  }
};

/// Random rays: all pairs of pieces that one meets (and that are met near it alike) are drawn far to near, in different levels.
int wrongPairs(const View& v, const std::vector<LayerPiece>& pieces, const LayerOrder& order, int rays, int* met) {
  const Places at(order, pieces.size());
  EXPECT_EQ(order.levels.back(), order.pieces.size());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int wrong = 0;
  for (int n = 0; n < rays; ++n) {
    const glm::dvec3 ray = v.ray(v.width * unit(random), v.height * unit(random));
    std::vector<std::pair<double, size_t>> hits;
    for (size_t i = 0; i < pieces.size(); ++i)
      if (const auto d = depthOf(pieces[i], ray, 1e-6); d && *d > v.near_m) hits.emplace_back(*d, i);
    std::sort(hits.begin(), hits.end(), std::greater<>());
    for (size_t k = 0; k < hits.size(); ++k)
      if (at.place[hits[k].second] < 0) ++wrong;  // seen, but not drawn
    for (size_t k = 0; k + 1 < hits.size(); ++k)
      for (size_t m = k + 1; m < hits.size(); ++m) {
        ++*met;
        const size_t far = hits[k].second, near = hits[m].second;
        if (hits[k].first - hits[m].first < 1e-9) continue;  // equally far: neighbours along an edge
        if (at.place[far] > at.place[near] || at.level[far] == at.level[near]) ++wrong;
      }
  }
  return wrong;
}

// Triangles of very different sizes, on slanted sheets that don't cross each other: sheet k lies between depths that belong to it alone.
TEST(LayerOrder, RandomTrianglesOnSeparateSheets) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const View v = viewOf(200, 0.4);
  std::vector<LayerPiece> pieces;
  for (int k = 0; k < 60; ++k) {
    // Planes z = -(20 + k/2 + a x + b y), all with the same a, b: parallel, much steeper than they are apart.
    const double size = std::pow(10.0, unit(random)), x = 8.0 * unit(random), y = 8.0 * unit(random);
    LayerPiece p;
    for (auto& c : p.corner) {
      const double cx = x + size * unit(random), cy = y + size * unit(random);
      c = {cx, cy, -(20.0 + 0.25 * k + 1.3 * cx - 0.8 * cy)};
    }
    p.triangle = static_cast<std::uint32_t>(k);
    pieces.push_back(p);
  }
  std::shuffle(pieces.begin(), pieces.end(), random);
  const LayerOrder order = orderLayers(v, pieces);
  EXPECT_TRUE(order.exact);
  EXPECT_EQ(order.cyclic, 0);
  int met = 0;
  bound("triangles on 60 sheets drawn in a wrong order", wrongPairs(v, pieces, order, 20000, &met), 0, "depth along 20000 random rays");
  EXPECT_GT(met, 10000);
}

// Small triangles that stay clear of each other and of a large one that runs through all their depths.
TEST(LayerOrder, SmallRandomTrianglesAndALargeOneAcross) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const View v = viewOf(200, 0.4);
  std::vector<LayerPiece> pieces(1);
  // One large triangle obliquely through the view; small ones clear of it on both sides and of each other (spheres around them don't touch).
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.8, 0.2, 0.4)), middle(0, 0, -20);
  const glm::dvec3 along = glm::normalize(glm::cross(normal, glm::dvec3(0, 1, 0))), up = glm::cross(along, normal);
  pieces[0].corner[0] = middle + 25.0 * along - 14.0 * up, pieces[0].corner[1] = middle - 25.0 * along - 14.0 * up, pieces[0].corner[2] = middle + 25.0 * up;
  std::vector<std::pair<glm::dvec3, double>> taken;
  while (pieces.size() < 400) {
    const double radius = 0.1 + 0.5 * std::abs(unit(random));
    const glm::dvec3 c(12.0 * unit(random), 12.0 * unit(random), -22.0 + 16.0 * unit(random));
    if (std::abs(glm::dot(c - middle, normal)) < radius) continue;
    if (std::any_of(taken.begin(), taken.end(), [&](const auto& t) { return glm::length(t.first - c) < t.second + radius; })) continue;
    taken.emplace_back(c, radius);
    LayerPiece p;
    for (auto& corner : p.corner) corner = c + radius * glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
    pieces.push_back(p);
  }
  const LayerOrder order = orderLayers(v, pieces);
  EXPECT_TRUE(order.exact);
  int met = 0;
  const int wrong = wrongPairs(v, pieces, order, 20000, &met);
  EXPECT_GT(met, 500);
  bound("399 small triangles about a large oblique one, in a wrong order", order.cyclic == 0 ? wrong : 0, 0, "depth along 20000 random rays");
  EXPECT_EQ(order.cyclic, 0);
}

// Closed shells of many triangles one in another: front and back halves, neighbours along edges.
TEST(LayerOrder, NestedShells) {
  const View v = viewOf(200, 0.4);
  std::vector<LayerPiece> pieces;
  for (double radius : {1.0, 2.0, 4.0}) {
    const int n = 16;
    auto at = [&](int i, int j) {
      const double a = 2.0 * kPi * i / n, e = kPi * (static_cast<double>(j) / n - 0.5);
      return glm::dvec3(0.3, -0.2, -20.0) + radius * glm::dvec3(std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a));
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int half = 0; half < 2; ++half) {
          LayerPiece p;
          p.corner[0] = at(i, j), p.corner[1] = half ? at(i + 1, j + 1) : at(i + 1, j), p.corner[2] = half ? at(i, j + 1) : at(i + 1, j + 1);
          pieces.push_back(p);
        }
  }
  const LayerOrder order = orderLayers(v, pieces);
  EXPECT_EQ(order.cyclic, 0);
  int met = 0;
  bound("nested shells of 1536 triangles, pairs in a wrong order", wrongPairs(v, pieces, order, 4000, &met), 0, "depth along 4000 random rays");
  EXPECT_GT(met, 2000);
}

// A ring of three: nothing is lost, nothing twice, and no level holds two that overlap.
TEST(LayerOrder, RingsAndCrossings) {
  const View v = viewOf(200, 0.4);
  std::vector<LayerPiece> pieces;
  for (int i = 0; i < 3; ++i) {
    const double a = 2.0 * kPi * i / 3.0;
    auto turned = [&](double x, double y, double z) { return glm::dvec3(x * std::cos(a) - y * std::sin(a), x * std::sin(a) + y * std::cos(a), z); };
    LayerPiece p;  // a long sliver along one side of a triangle, its far end behind
    p.corner[0] = turned(-4.0, -1.2, -19.0), p.corner[1] = turned(4.0, -1.4, -22.0), p.corner[2] = turned(4.0, -0.8, -22.0);
    pieces.push_back(p);
  }
  // Two that cross, elsewhere, and one behind all.
  LayerPiece p;
  p.corner[0] = {5, 5, -18}, p.corner[1] = {7, 5, -22}, p.corner[2] = {6, 7, -20};
  pieces.push_back(p);
  p.corner[0] = {5, 5, -22}, p.corner[1] = {7, 5, -18}, p.corner[2] = {6, 7, -20.5};
  pieces.push_back(p);
  p.corner[0] = {-30, -30, -40}, p.corner[1] = {30, -30, -40}, p.corner[2] = {0, 40, -40};
  pieces.push_back(p);
  const LayerOrder order = orderLayers(v, pieces);
  ASSERT_EQ(order.pieces.size(), pieces.size());
  EXPECT_GE(order.cyclic, 1);
  const Places at(order, pieces.size());
  EXPECT_EQ(at.place[5], 0);
  EXPECT_NE(at.level[3], at.level[4]);
  for (size_t i = 0; i < 3; ++i) EXPECT_NE(at.level[i], at.level[(i + 1) % 3]);
}

// A long pane that is behind a ball of gas but for one end, which reaches into it: the line through the middle of what they share does not show that.
TEST(LayerOrder, AnEndOfAPaneInGas) {
  const View v = viewOf(200, 0.4);
  LayerPiece gas;
  gas.medium = true;
  gas.origin = {0.0, 0.0, -20.0};
  gas.form = {BodyForm::Kind::Ellipsoid, {1.0, 1.0, 1.0}};
  gas.low = glm::dvec3(-1.0), gas.high = glm::dvec3(1.0);
  LayerPiece pane;
  const auto ending = [&](double x) {
    pane.corner[0] = {x, -5.0, -20.0}, pane.corner[1] = {x, 5.0, -20.0}, pane.corner[2] = {x - 6.0, 0.0, -32.0};
    return orderLayers(v, {gas, pane});
  };
  EXPECT_EQ(ending(0.6).crossing, 1);
  EXPECT_EQ(ending(0.6).describe(), "exact but for 1 pair that passes through each other");
  EXPECT_EQ(ending(-1.5).crossing, 0);
}

// Pieces at the edges of what can be drawn.
TEST(LayerOrder, DegenerateAndOutOfView) {
  const View v = viewOf(100, 0.4);
  std::vector<LayerPiece> pieces(6);
  auto set = [&](size_t i, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { pieces[i].corner[0] = a, pieces[i].corner[1] = b, pieces[i].corner[2] = c; };
  set(0, {0, 0, 5}, {1, 0, 5}, {0, 1, 5});           // behind the camera
  set(1, {0, 0, -5}, {0, 0, -5}, {0, 1, -5});        // no area
  set(2, {0, 1, -5}, {0, -1, -5}, {0, 0, -9});       // seen on edge
  set(3, {100, 0, -5}, {101, 0, -5}, {100, 1, -5});  // beside the picture
  set(4, {-1, -1, 1}, {1, -1, -3}, {0, 2, -3});      // through the near plane
  set(5, {-9, -9, -8}, {9, -9, -8}, {0, 9, -8});     // plain
  const LayerOrder order = orderLayers(v, pieces);
  EXPECT_EQ(order.pieces, (std::vector<std::uint32_t>{5, 4}));
  EXPECT_EQ(orderLayers(v, {}).pieces.size(), 0u);
}

}  // namespace
}  // namespace pitviper::test
