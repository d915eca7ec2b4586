// The tree over a mesh's triangles, what meshes can hide of themselves, and exact shadow rays.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "scenarios/assets/make_aircraft.hpp"
#include "sim/radiance/shadow_rays.hpp"
#include "sim/scene/primitives.hpp"
#include "sim/scene/triangle_tree.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(TriangleTree, MeetsWhatTestingEveryTriangleMeets) {
  std::mt19937 random(3);
  std::uniform_real_distribution<> unit(-1.0, 1.0);
  for (const Mesh& mesh : {makeJet(), makeTerrain({.size_m = 12.0, .columns = 80, .relief_m = 4.0}), makePlate(9, 9), makeSphere(5.0)}) {
    const TriangleTree tree(mesh);
    std::set<std::uint32_t> held(tree.order().begin(), tree.order().end());
    EXPECT_EQ(held.size(), mesh.triangles.size());
    long met = 0, looked = 0;
    for (int n = 0; n < 300; ++n) {
      const glm::dvec3 origin(8 * unit(random), 8 * unit(random), 8 * unit(random));
      glm::dvec3 direction(unit(random), unit(random), unit(random));
      if (n % 7 == 0) direction[n % 3] = 0.0;
      std::vector<std::uint32_t> brute, found;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const TriangleMeeting m = meetTriangle(mesh, t, origin, direction);
        if (m.met && m.along >= 0.0) brute.push_back(t);
      }
      const double endless = INFINITY;
      tree.along(origin, direction, 0.0, endless, [&](std::uint32_t t) {
        ++looked;
        const TriangleMeeting m = meetTriangle(mesh, t, origin, direction);
        if (m.met && m.along >= 0.0) found.push_back(t);
        return false;
      });
      std::sort(found.begin(), found.end());
      EXPECT_EQ(brute, found);
      met += static_cast<long>(brute.size());
    }
    EXPECT_GT(met, 10);
    if (mesh.triangles.size() > 1000) {
      EXPECT_LT(looked, 300 * static_cast<long>(mesh.triangles.size()) / 50);
    }
  }
}

TEST(TriangleTree, IsTheSameEveryTime) {
  const Mesh jet = makeJet();
  EXPECT_EQ(TriangleTree(jet).order(), TriangleTree(jet).order());
}

TEST(TriangleTree, OneTriangleAndManyInOnePlace) {
  Mesh mesh = makePlate(1, 1);
  const glm::uvec3 first = mesh.triangles[0];
  mesh.triangles.assign(100, first);
  const TriangleTree many(mesh), one(mesh, {7});
  int seen = 0;
  const double endless = INFINITY;
  const glm::dvec3 inside = glm::dvec3(mesh.positions[first.x] + mesh.positions[first.y] + mesh.positions[first.z]) / 3.0;
  auto count = [&](std::uint32_t) { return ++seen, false; };
  many.along(inside + glm::dvec3(1, 0, 0), {-1, 0, 0}, 0.0, endless, count);
  EXPECT_EQ(seen, 100);
  one.along(inside + glm::dvec3(1, 0, 0), {-1, 0, 0}, 0.0, endless, count);
  EXPECT_EQ(seen, 101);
  one.along(inside + glm::dvec3(1, 0, 0), {1, 0, 0}, 0.0, endless, count);
  EXPECT_EQ(seen, 101);
}

TEST(TriangleTree, Bulk) {
  auto bulk = [](Mesh mesh) { return bulkOf(std::make_shared<const Mesh>(std::move(mesh))); };
  EXPECT_EQ(bulk(makePlate(3, 2, 4, 4)), Bulk::Flat);
  EXPECT_EQ(bulk(makeDisc(1)), Bulk::Flat);
  EXPECT_EQ(bulk(makeSphere(2)), Bulk::Convex);
  EXPECT_EQ(bulk(makeEllipsoid(3, 2, 1)), Bulk::Convex);
  EXPECT_EQ(bulk(makeBox(3, 2, 1)), Bulk::Convex);
  EXPECT_EQ(bulk(makeCone(1, 0, 2)), Bulk::Convex);
  EXPECT_EQ(bulk(makeCylinder(1, 2, 64, false)), Bulk::Other) << "one sees into it";
  EXPECT_EQ(bulk(makeJet()), Bulk::Other);
  EXPECT_EQ(bulk(makeTerrain({.size_m = 100, .columns = 20})), Bulk::Other);
}

/// A surface of entity 0 at a place, seen from above.
Hit upwards(const glm::dvec3& point) {
  Hit hit;
  hit.entity = hit.surface = 0;
  hit.distance = 10.0;
  hit.point = point;
  return hit;
}

constexpr const char* kCamera =
    "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 20 deg, aperture: 5 mm, position: [30 m, 0 m, 9 m], look_at: [0 m, 0 m, 0 m], "
    "channels: [{name: a, response: {band: [3 um, 4 um]}}]}]\n";

// A square of 2 m, 3 m over the ground: by lines.
TEST(ShadowRays, SquareOverGround) {
  const auto sim = scene(std::string("entities:\n"
                                     "  - {name: ground, shape: {model: plate, width: 20 m, height: 20 m}, material: sand, temperature: 300 K, pitch: 90 deg}\n"
                                     "  - {name: square, shape: {model: plate, width: 2 m, height: 2 m}, material: sand, temperature: 300 K, pitch: 90 deg, "
                                     "position: [0 m, 0 m, 3 m]}\n") +
                         kCamera);
  const WorldState state = advance(sim, 0.0);
  const ShadowCaster shadows(sim);
  std::mt19937 random(7);
  std::uniform_real_distribution<> unit(-1.0, 1.0);
  int shaded = 0;
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 at(4 * unit(random), 4 * unit(random), 0.0), light(3 * unit(random), 3 * unit(random), 2.0 + 6.0 * std::abs(unit(random)));
    const double d = glm::length(light - at);
    const glm::dvec3 crossing = at + (light - at) * (3.0 / light.z);
    const bool want = light.z > 3.0 && std::abs(crossing.x) < 1.0 && std::abs(crossing.y) < 1.0;
    EXPECT_EQ(shadows.lit(state, upwards(at), (light - at) / d, d), !want);
    const glm::dvec3 sky = at + (light - at) * (3.0 / light.z);
    EXPECT_EQ(shadows.lit(state, upwards(at), (light - at) / d, INFINITY), !(std::abs(sky.x) < 1.0 && std::abs(sky.y) < 1.0));
    shaded += want;
  }
  EXPECT_GT(shaded, 100);
}

// Facets of a coarse closed body that face away from a light, though their smooth normals face it, stay lit; a wall beside them is seen.
TEST(ShadowRays, TerminatorOfACoarseBody) {
  const auto sim =
      scene(std::string("entities:\n"
                        "  - {name: missile, shape: {model: missile}, material: sand, temperature: 300 K}\n"
                        "  - {name: far, shape: {model: sphere, radius: 1 m}, material: sand, temperature: 300 K, position: [900 m, 0 m, 0 m]}\n") +
            kCamera);
  const WorldState state = advance(sim, 0.0);
  const ShadowCaster shadows(sim);
  // The tube between nose and fins is convex around: every place that the smooth normal calls lit by a light abeam must be lit.
  int away = 0;
  for (int k = 0; k < 2000; ++k) {
    const double angle = 2.0 * M_PI * (k + 0.5) / 2000.0;
    const glm::dvec3 out(0.0, std::cos(angle), std::sin(angle));
    const Hit hit = castRay(sim, state, glm::dvec3(0.3, 0, 0) + 5.0 * out, -out, 0.01).solid;
    ASSERT_EQ(hit.entity, 0);
    const glm::dvec3 toLight(0.0, std::cos(0.03), std::sin(0.03));  // not along an edge
    if (glm::dot(hit.normal, toLight) <= 0.0) continue;
    away += glm::dot(hit.facet, toLight) < 0.0;
    EXPECT_TRUE(shadows.lit(state, hit, toLight, INFINITY)) << angle;
  }
  EXPECT_GT(away, 0);
}

}  // namespace
}  // namespace pitviper::test
