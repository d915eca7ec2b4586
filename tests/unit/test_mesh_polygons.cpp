// Polygons of mesh files: cut into triangles of their own area, or refused where they stand.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/mesh_import.hpp"
#include "tests/support/random_polygons.hpp"

namespace pitviper {
namespace {

using MeshPolygons = test::MeshImport;

std::string vertex(const glm::dvec3& p) {
  char line[100];
  std::snprintf(line, sizeof line, "v %.12g %.12g %.12g\n", p.x, p.y, p.z);
  return line;
}

/// Sum of a part's triangles.
double areaOf(const Mesh& mesh, const MeshPart& part) {
  double sum = 0.0;
  for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t) {
    const glm::uvec3& i = mesh.triangles[t];
    const glm::dvec3 a(mesh.positions[i.x]);
    sum += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[i.y]) - a, glm::dvec3(mesh.positions[i.z]) - a));
  }
  return sum;
}

}  // namespace

// Stars and combs with holes, bridges, corners on lines, spikes and corners written twice; as they are, and rounded as programs write them, so that what
// touched crosses a little. Sums of areas without sign: nothing is covered twice, nothing is left out.
TEST_F(MeshPolygons, ThousandHaveTheirArea) {
  for (const bool rounded : {false, true}) {
    std::string text;
    std::vector<double> areas;
    int corners = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      const test::RandomPolygon polygon(seed);
      std::string face = "f";
      std::mt19937_64 random(seed);
      for (glm::dvec3 p : polygon.corners()) {
        // Each corner by itself, as if written from sums of its own: those at one place part.
        for (int k = 0; rounded && k < 3; ++k) p[k] = 1e-5 * std::round(1e5 * p[k] + std::uniform_real_distribution<double>(-0.5, 0.5)(random));
        text += vertex(p), face += " " + std::to_string(++corners);
      }
      text += "g p" + std::to_string(seed) + "\n" + face + "\n";
      areas.push_back(polygon.area());
    }
    const Mesh mesh = import("polygons.obj", text);
    ASSERT_EQ(mesh.parts.size(), areas.size());
    double worst = 0.0;
    for (std::size_t k = 0; k < areas.size(); ++k) worst = std::max(worst, std::abs(areaOf(mesh, mesh.parts[k]) / areas[k] - 1.0));
    if (rounded) test::bound("the same with corners rounded to five decimals, each by itself", worst, 1e-4, "1e-5 of a border of 10 to 60 about 2 to 40");
    else test::bound("area of 1000 polygons from a file against the shoelace formula, relative", worst, 1e-6, "vertices in single precision");
  }
}

// Five corners at random: what crosses itself is refused, what does not has its area.
TEST_F(MeshPolygons, CrossingOnesAreRefusedAtTheirLine) {
  std::mt19937_64 random(7);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
  const auto side = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) { return glm::cross(b - a, c - a).z; };
  int refused = 0, cut = 0;
  for (int k = 0; k < 60; ++k) {
    std::vector<glm::dvec3> p;
    std::string text = "# five corners\n", face = "f";
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 5; ++i) p.emplace_back(unit(), unit(), 0.0), text += vertex(p.back()), face += " " + std::to_string(i + 1);
    bool crosses = false;
    for (std::size_t i = 0; i < 5; ++i) {
      sum += 0.5 * glm::cross(p[i], p[(i + 1) % 5]);
      for (const std::size_t j : {i + 2, i + 3}) {
        const glm::dvec3 &a = p[i], &b = p[(i + 1) % 5], &c = p[j % 5], &d = p[(j + 1) % 5];
        crosses |= side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
      }
    }
    const auto file = write("five.obj", text + "\n" + face + "\n");
    const std::string said = complaint(file);
    ++(crosses ? refused : cut);
    if (crosses) {
      EXPECT_TRUE(said.starts_with(file.string() + ":8:1: face 1 crosses itself; expected a face whose edges meet at corners only; fix: ")) << said;
    } else {
      EXPECT_EQ(said, "");
      EXPECT_NEAR(surfaceArea(importMesh(file, 1.0, {})), std::abs(sum.z), 1e-6);
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(cut, 10);
  const std::string eight = "v -1 -1 0\nv 0 0 0\nv 1 1 0\nv 1 -1 0\nv -1 1 0\n";
  EXPECT_NE(complaint(write("eight.obj", eight + "f 1 2 3 4 2 5\n")), "");              // through its own corner
  EXPECT_NE(complaint(write("bow.obj", eight + "f 1 3 4 5\n")), "");                    // its areas cancel
  EXPECT_NEAR(surfaceArea(import("wings.obj", eight + "f 1 2 4 3 2 5\n")), 2.0, 1e-6);  // touches at a corner
}

// The same polygons in other formats: a U with a corner twice, and a bow tie at its place.
TEST_F(MeshPolygons, InEveryFormatThatHasThem) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 9\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n3 0 0\n3 2 0\n2 2 0\n2 1 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n";
  EXPECT_NEAR(surfaceArea(import("u.ply", header + points + "9 0 1 2 3 4 5 6 7 8\n")), 5.0, 1e-9);
  const auto bow = write("bow.ply", header + points + "4 0 2 1 8\n");
  EXPECT_TRUE(complaint(bow).starts_with(bow.string() + ":19:1: face 1 crosses itself")) << complaint(bow);
  const auto vtp = [&](const std::string& face, int count) {
    return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"9\" NumberOfPolys=\"1\"><Points>"
           "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" +
           points +
           "</DataArray></Points><Polys>"
           "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
           face +
           "</DataArray>"
           "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" +
           std::to_string(count) + "</DataArray></Polys></Piece></PolyData></VTKFile>\n";
  };
  EXPECT_NEAR(surfaceArea(import("u.vtp", vtp("0 1 2 3 4 5 6 7 8", 9))), 5.0, 1e-9);
  EXPECT_NE(complaint(write("bow.vtp", vtp("0 2 1 8", 4))).find("face 1 crosses itself"), std::string::npos);
}

// A cube whose sides have corners on their edges and written twice stays closed: no triangle's edge runs over a corner of the next.
TEST_F(MeshPolygons, CutSidesStayClosed) {
  std::string text;
  for (int k = 0; k < 8; ++k) text += vertex({k & 1, k >> 1 & 1, k >> 2 & 1});
  text += "v 0.3 0 0\nv 0.7 0 0\nv 0.5 0 1\n";  // on the edges below and above the front
  text += "f 1 3 4 2 10 9\nf 5 11 6 8 7\nf 1 9 9 10 2 6 6 11 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const Mesh cube = import("cube.obj", text);
  EXPECT_TRUE(cube.closed);
  EXPECT_NEAR(signedVolume(cube), 1.0, 1e-6);
  EXPECT_TRUE(cube.notes.empty());
}

// A ring of 1024 corners, the most that a face may have: a disc, within the time that its file is given.
TEST_F(MeshPolygons, ManyCorners) {
  std::string text, face = "f";
  for (int i = 0; i < 1024; ++i) {
    const double a = 2.0 * kPi * i / 1024, r = i % 2 ? 1.0 : 0.5;
    text += vertex({r * std::cos(a), r * std::sin(a), 0.0});
    face += " " + std::to_string(i + 1);
  }
  EXPECT_NEAR(surfaceArea(import("star.obj", text + face + "\n")), 0.5 * 1024 * 0.5 * std::sin(2.0 * kPi / 1024), 1e-5);
}

}  // namespace pitviper
