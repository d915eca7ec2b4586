// Which way meshes from files stand, what their size says of their unit, and level ground.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/scene/mesh_axes.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/mesh_units.hpp"
#include "sim/scene/primitives.hpp"

namespace pitviper {
namespace {

TEST(MeshAxes, Names) {
  EXPECT_EQ(*axisNamed("+x"), glm::ivec3(1, 0, 0));
  EXPECT_EQ(*axisNamed("-z"), glm::ivec3(0, 0, -1));
  for (const char* word : {"", "x", "+w", "++", "-zz", "*y"}) EXPECT_FALSE(axisNamed(word)) << word;
  EXPECT_EQ(usualAxes("a.GLB").up, glm::ivec3(0, 1, 0));
  EXPECT_EQ(usualAxes("a.obj").forward, glm::ivec3(1, 0, 0));
}

// Every one of the 24 attitudes: nose to x, upper side to z, and a rotation (volume stays positive, the third axis is right).
TEST(MeshAxes, NoseGoesForwardAndTopUpInAll24) {
  int cases = 0;
  for (const char* f : {"+x", "-x", "+y", "-y", "+z", "-z"})
    for (const char* u : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
      const FileAxes meant{*axisNamed(f), *axisNamed(u)};
      if (meant.forward == meant.up || meant.forward == -meant.up) continue;
      ++cases;
      for (const char* file : {"a.obj", "a.glb"}) {
        const FileAxes usual = usualAxes(file);
        // A box in the file's axes, read as the format's usual axes say: body coordinates are those along forward, left and up.
        Mesh mesh = makeBox(1.0, 2.0, 3.0);
        mesh.positions = {glm::vec3(meant.forward) * 5.0f, glm::vec3(meant.up) * 7.0f};
        mesh.normals = {glm::vec3(meant.forward), glm::vec3(meant.up)};
        const glm::vec3 uf(usual.forward), uu(usual.up), ul = glm::cross(uu, uf);
        for (auto* v : {&mesh.positions, &mesh.normals})
          for (glm::vec3& p : *v) p = {glm::dot(p, uf), glm::dot(p, ul), glm::dot(p, uu)};
        turnAxes(mesh, usual, meant);
        EXPECT_EQ(mesh.positions[0], glm::vec3(5, 0, 0)) << f << u << file;
        EXPECT_EQ(mesh.positions[1], glm::vec3(0, 0, 7)) << f << u << file;
        EXPECT_EQ(mesh.normals[0], glm::vec3(1, 0, 0));
        EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 1));
        Mesh box = makeBox(1.0, 2.0, 3.0);
        turnAxes(box, usual, meant);
        EXPECT_NEAR(signedVolume(box), 6.0, 1e-5);
        EXPECT_TRUE(isClosed(box));
      }
    }
  EXPECT_EQ(cases, 24);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(MeshUnits, SizesThatSmell) {
  EXPECT_EQ(doubtAboutUnit({15.1, 10.5, 4.0}, 1.0, "jet.obj"), "");
  EXPECT_EQ(doubtAboutUnit({2.9, 0.3, 0.3}, 1e-3, "missile.stl"), "");
  EXPECT_EQ(doubtAboutUnit({120.0, 20.0, 30.0}, 0.3048, "ship.obj"), "");  // feet were said to be
  const std::string mm = doubtAboutUnit({15100.0, 10500.0, 4000.0}, 1.0, "jet.obj");
  EXPECT_TRUE(has(mm, "15100 m long") && has(mm, "15.1 m if the file is in millimetres")) << mm;
  const std::string ft = doubtAboutUnit({49.5, 34.4, 13.0}, 1.0, "jet.obj");
  EXPECT_TRUE(has(ft, "15.1 m if the file is in feet")) << ft;
  const std::string small = doubtAboutUnit({0.0151, 0.0105, 0.004}, 1e-3, "jet.obj");
  EXPECT_TRUE(has(small, "15.1 m if the file is in metres")) << small;
  EXPECT_TRUE(has(doubtAboutUnit({0.03, 0.02, 0.01}, 1e-3, "jet.glb"), "glTF files are in metres"));
  EXPECT_EQ(doubtAboutUnit({30.0, 20.0, 10.0}, 1.0, "jet.glb"), "");
}

// Vertices on the sphere to single precision, facets below it by no more than the header says, normals those of the sphere, nothing missing: the area
// of a sphere's cap is 2 pi R h.
TEST(Ground, IsACapOfTheEarth) {
  const double R = 6371000.0, extent = 4e5;
  const Mesh ground = makeGround(extent, R);
  EXPECT_TRUE(ground.heightField);
  EXPECT_LT(ground.triangles.size(), 45000u);
  double worst = 0.0;
  for (size_t i = 0; i < ground.positions.size(); ++i) {
    const glm::dvec3 p(ground.positions[i]), fromCentre = p + glm::dvec3(0, 0, R);
    worst = std::max(worst, std::abs(glm::length(fromCentre) - R));
    EXPECT_LT(glm::length(glm::dvec3(ground.normals[i]) - fromCentre / R), 1e-6);
  }
  EXPECT_LT(worst, 0.1);  // single precision of 400 km: 0.03 m
  double deepest = 0.0, deepestNear = 0.0, highest = 0.0;
  for (const glm::uvec3& t : ground.triangles) {
    const glm::dvec3 a(ground.positions[t.x]), b(ground.positions[t.y]), c(ground.positions[t.z]);
    EXPECT_GT(glm::cross(b - a, c - a).z, 0.0);
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; j <= 4 - i; ++j) {
        const glm::dvec3 p = a + (b - a) * (i / 4.0) + (c - a) * (j / 4.0);
        const double below = R - glm::length(p + glm::dvec3(0, 0, R));
        deepest = std::max(deepest, below);
        highest = std::max(highest, -below);
        if (std::hypot(p.x, p.y) < 1e4) deepestNear = std::max(deepestNear, below);
      }
  }
  EXPECT_LT(deepest, 4.0);
  EXPECT_GT(deepest, 1.0);  // the bound is no idle one
  EXPECT_LT(deepestNear, 0.1);
  EXPECT_LT(highest, 0.1);
  const double h = R - std::sqrt(R * R - extent * extent);
  EXPECT_NEAR(surfaceArea(ground) / (2.0 * 3.14159265358979 * R * h), 1.0, 2e-4);  // a polygon of 256 sides: 1.0e-4
}

TEST(Ground, TextureCoordinates) {
  const Mesh whole = makeGround(1000.0, 6371000.0), tiled = makeGround(1000.0, 6371000.0, 50.0);
  for (size_t i = 0; i < whole.positions.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(whole.uv[i].x), 0.5 + static_cast<double>(whole.positions[i].x) / 2000.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(tiled.uv[i].y), static_cast<double>(tiled.positions[i].y) / 50.0, 1e-5);
  }
  EXPECT_THROW(makeGround(4e6, 6371000.0), std::invalid_argument);
  EXPECT_THROW(makeGround(0.0, 6371000.0), std::invalid_argument);
}

}  // namespace
}  // namespace pitviper
