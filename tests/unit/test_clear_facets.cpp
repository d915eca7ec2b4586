// Facets that their own body leaves clear of the sun, against rays in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenarios/assets/make_aircraft.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/primitives.hpp"
#include "sim/scene/triangle_tree.hpp"
#include "sim/world/clear_facets.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

/// Whether another triangle of the mesh stands between a point of one and the light.
bool isShaded(const Mesh& mesh, const TriangleTree& tree, std::uint32_t own, const glm::dvec3& point, const glm::dvec3& toLight) {
  bool met = false;
  const double farthest = 1e9;
  tree.along(point, toLight, 0.0, farthest, [&](std::uint32_t t) {
    const TriangleMeeting m = t == own ? TriangleMeeting{} : meetTriangle(mesh, t, point, toLight);
    met |= m.met && m.along > 1e-9;
    return met;
  });
  return met;
}

struct Tally {
  long clear = 0, lit = 0, shadedPoints = 0, points = 0;
};

/// Some facets that face the light, ten points on each, not too near its edges.
Tally tally(const std::shared_ptr<const Mesh>& mesh, const glm::dvec3& toLight, std::uint32_t step) {
  const auto tree = treeOf(mesh);
  const std::vector<char> clear = clearFacets(*mesh, toLight);
  EXPECT_EQ(clear.size(), mesh->triangles.size());
  std::mt19937 random(7);
  std::uniform_real_distribution<> share(0.0, 1.0);
  Tally sum;
  for (std::uint32_t t = 0; t < clear.size(); t += step) {
    const glm::dvec3 a(mesh->positions[mesh->triangles[t].x]), b(mesh->positions[mesh->triangles[t].y]), c(mesh->positions[mesh->triangles[t].z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, toLight) <= 1e-6 * glm::length(normal)) {
      EXPECT_FALSE(clear[t] && glm::dot(normal, toLight) < -1e-6 * glm::length(normal)) << "a facet that faces away";
      continue;
    }
    long shaded = 0;
    for (int n = 0; n < 10; ++n) {
      double v = share(random), w = share(random);
      if (v + w > 1.0) v = 1.0 - v, w = 1.0 - w;
      const glm::dvec3 middle = (a + b + c) / 3.0;
      shaded += isShaded(*mesh, *tree, t, middle + 0.999 * (a + v * (b - a) + w * (c - a) - middle), toLight);
    }
    sum.points += clear[t] ? 10 : 0;
    sum.shadedPoints += clear[t] ? shaded : 0;
    sum.clear += clear[t];
    sum.lit += shaded == 0;
  }
  return sum;
}

glm::dvec3 sunAt(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kPi / 180.0, e = elevation_deg * kPi / 180.0;
  return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

TEST(ClearFacets, NothingShadesThem) {
  const auto terrain = std::make_shared<const Mesh>(makeTerrain(TerrainShape{.size_m = 10000.0, .columns = 120, .relief_m = 900.0, .seed = 5}));
  const auto jet = std::make_shared<const Mesh>(makeJet());
  const auto ball = std::make_shared<const Mesh>(makeSphere(2.0));
  Tally all;
  for (const auto& mesh : {terrain, jet, ball})
    for (double elevation : {4.0, 12.0, 35.0, 88.0})
      for (double azimuth : {20.0, 135.0, 271.0}) {
        const Tally t = tally(mesh, sunAt(azimuth, elevation), mesh == ball ? 3 : 17);
        all.clear += t.clear, all.lit += t.lit, all.points += t.points, all.shadedPoints += t.shadedPoints;
        EXPECT_LE(t.clear, t.lit + t.lit / 100) << "no more than rays find lit";
        // Nearly all of what a high sun sees of the ground, and of a convex body but along its limb.
        if (mesh == ball || (mesh == terrain && elevation > 80.0)) {
          EXPECT_GE(t.clear, t.lit - t.lit / 10);
        }
      }
  EXPECT_GT(all.points, 10000);
  bound("shaded points of clear facets, of " + std::to_string(all.points), static_cast<double>(all.shadedPoints), 0.0, "none");
  std::printf("clear %ld of %ld lit facets\n", all.clear, all.lit);
}

// A roof over half of a floor.
TEST(ClearFacets, UnderARoof) {
  Mesh mesh = makePlate(4.0, 4.0, 4, 1);  // strips along y, in the plane x = 0, its normal along x
  const size_t floor = mesh.triangles.size();
  const Mesh roof = makePlate(1.9, 4.0);
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& p : roof.positions) mesh.positions.push_back(p + glm::vec3(1.0f, 1.05f, 0.0f));
  for (const auto& t : roof.triangles) mesh.triangles.push_back(t + base);
  const std::vector<char> clear = clearFacets(mesh, {1.0, 0.0, 0.0});
  for (size_t t = 0; t < clear.size(); ++t) {
    double y = 0.0;
    for (int k = 0; k < 3; ++k) y += static_cast<double>(mesh.positions[mesh.triangles[t][k]].y) / 3.0;
    EXPECT_EQ(clear[t] != 0, t >= floor || y < 0.0) << t << " at y " << y;
  }
  const std::vector<char> below = clearFacets(mesh, {-1.0, 0.0, 0.0});
  EXPECT_EQ(std::count(below.begin(), below.end(), 1), 0) << "their backs";
}

// Two sheets of unlike facets, one 25 m over the other: seen along a slant, their facets reach past each other, but planes part them. A third body stands over
// the upper one.
TEST(ClearFacets, OtherBodies) {
  const Mesh upper = makeTerrain(TerrainShape{.size_m = 2000.0, .columns = 60, .relief_m = 40.0, .seed = 4});
  const Mesh lower = makeTerrain(TerrainShape{.size_m = 6000.0, .columns = 30, .relief_m = 20.0, .seed = 9});
  const Mesh roof = makeBox(100.0, 100.0, 1.0);
  const glm::dvec3 sun = sunAt(200.0, 28.0), down(0.0, 0.0, -60.0), corner(100.0, -200.0, 150.0);
  const auto count = [](const std::vector<char>& clear) { return std::count(clear.begin(), clear.end(), 1); };
  const std::vector<char> alone = clearFacets(upper, sun), over = clearFacets(upper, sun, std::vector<Occluder>{{lower, glm::dmat3(1.0), down}}),
                          under = clearFacets(lower, sun, std::vector<Occluder>{{upper, glm::dmat3(1.0), -down}}),
                          roofed = clearFacets(upper, sun, std::vector<Occluder>{{lower, glm::dmat3(1.0), down}, {roof, glm::dmat3(1.0), corner}});
  EXPECT_EQ(count(over), count(alone)) << "what lies below shades nothing";
  // Its shadow, 100 m wide and longer, on facets of 33 m: of (100 + 33)^2 / 33^2 cells or so, two facets each.
  const long lost = count(over) - count(roofed);
  EXPECT_GT(lost, 12);
  EXPECT_LT(lost, 80);
  // Of the lower sheet what the upper one covers as the sun sees it: 2000 m square of 6000.
  EXPECT_GT(count(under), 1400);
  EXPECT_LT(count(under), 1620);
  // The shadow lies where it falls: behind the roof, as far as its height by the sun's.
  for (size_t t = 0; t < roofed.size(); ++t) {
    if (!over[t] || roofed[t]) continue;
    glm::dvec3 middle(0.0);
    for (int k = 0; k < 3; ++k) middle += glm::dvec3(upper.positions[upper.triangles[t][k]]) / 3.0;
    const glm::dvec3 up = middle + sun * ((corner.z - middle.z) / sun.z);
    EXPECT_LT(std::max(std::abs(up.x - corner.x), std::abs(up.y - corner.y)), 50.0 + 40.0);
  }
}

// Meshes on which every pair would have to be looked at: nothing is known of them, at once.
TEST(ClearFacets, FansAndSmallDetails) {
  const Mesh fan = makeDisc(1.0, 200000);
  const std::vector<char> ofFan = clearFacets(fan, {1.0, 0.0, 0.0});
  EXPECT_EQ(std::count(ofFan.begin(), ofFan.end(), 1), 0);
  Mesh detail = makeTerrain(TerrainShape{.size_m = 1.0, .columns = 200, .relief_m = 0.1, .seed = 2});
  const Mesh far = makePlate(1.0, 1.0);
  const auto base = static_cast<std::uint32_t>(detail.positions.size());
  for (const auto& p : far.positions) detail.positions.push_back(p + glm::vec3(1e6f, 1e6f, 0.0f));
  for (const auto& t : far.triangles) detail.triangles.push_back(t + base);
  const std::vector<char> clear = clearFacets(detail, {0.0, 0.0, 1.0});
  EXPECT_EQ(std::count(clear.begin(), clear.end(), 1), 0);
}

}  // namespace
}  // namespace pitviper::test
