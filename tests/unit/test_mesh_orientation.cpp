// Which way the shells of meshes face: assemblies of closed shells that were mirrored, turned, hollowed and merged, against their signed volumes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <random>
#include <set>

#include "sim/radiometry/constants.hpp"
#include "sim/scene/mesh_normals.hpp"
#include "sim/scene/mesh_orientation.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/primitives.hpp"
#include "tests/support/figures.hpp"

namespace pitviper {
namespace {

constexpr double kCrease = 40.0 * kPi / 180.0;

/// A mesh that is put together, and which way each triangle shall go round once it is oriented.
struct Assembly {
  Mesh mesh;
  std::vector<char> right;
  double volume = 0.0;
  std::mt19937_64 random;

  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); }
  bool toss(double share = 0.5) { return unit() < share; }

  Mesh shape() {
    switch (random() % 4) {
      case 0:
        return makeBox(1.0 + unit(), 1.0 + unit(), 1.0 + unit());
      case 1:
        return makeSphere(0.5 + 0.5 * unit(), 6 + static_cast<int>(random() % 6));
      case 2:
        return makeCylinder(0.5 + 0.3 * unit(), 1.0 + unit(), 5 + static_cast<int>(random() % 8));
      default:
        return makeCone(0.6 + 0.3 * unit(), toss() ? 0.0 : 0.3, 1.0 + unit(), 5 + static_cast<int>(random() % 8));
    }
  }

  /// Appends a shell, moved; `mirrored` by the placement alone, as exporters do that leave the winding as it was. `turned`: its triangles go round the
  /// wrong way: none, all, or some.
  void add(Mesh shell, const glm::mat4& placement, const std::string& name, bool hollow, double turned) {
    for (glm::vec3& p : shell.positions) p = glm::vec3(placement * glm::vec4(p, 1.0f));
    const bool mirrored = glm::determinant(glm::mat3(placement)) < 0.0f;
    for (glm::vec3& n : shell.normals) n = glm::normalize(glm::vec3(glm::inverse(glm::transpose(placement)) * glm::vec4(n, 0.0f)));
    shell.parts = {{name, 0, static_cast<std::uint32_t>(shell.triangles.size())}};
    if (hollow)
      for (glm::vec3& n : shell.normals) n = -n;
    volume += (hollow ? -1.0 : 1.0) * std::abs(signedVolume(shell));
    const auto first = mesh.triangles.size();
    appendPart(mesh, shell, name, glm::mat4(1.0f));
    for (std::size_t t = first; t < mesh.triangles.size(); ++t) {
      const bool asIs = toss(turned);
      right.push_back(asIs == (mirrored == hollow) ? 0 : 1);  // 1: goes round the right way now
      if (asIs) std::swap(mesh.triangles[t].x, mesh.triangles[t].y);
    }
  }

  /// A body at a place of its own: a shell with others within it, to a random depth.
  void addBody(const glm::vec3& at, const std::string& name) {
    glm::mat4 placement = glm::translate(glm::mat4(1.0f), at);
    placement = glm::rotate(placement, static_cast<float>(6.0 * unit()), glm::normalize(glm::vec3(unit(), unit(), 0.1 + unit())));
    if (toss()) placement = glm::scale(placement, glm::vec3(toss() ? -1.0f : 1.0f, toss() ? -1.0f : 1.0f, toss() ? -1.0f : 1.0f));
    const Mesh outer = shape();
    const int depth = toss() ? 1 : 1 + static_cast<int>(random() % 4);
    for (int d = 0; d < depth; ++d) {
      const double kind = unit();
      add(outer, glm::scale(placement, glm::vec3(std::pow(0.6f, static_cast<float>(d)))), name, d % 2 == 1, kind < 0.3 ? 0.0 : kind < 0.6 ? 1.0 : unit());
    }
  }

  /// Without an order of its own, and perhaps without indices.
  void shuffle() {
    if (toss()) {
      Mesh soup = mesh;
      soup.positions.clear(), soup.normals.clear(), soup.uv.clear();
      for (glm::uvec3& t : soup.triangles)
        for (int k = 0; k < 3; ++k) {
          soup.positions.push_back(mesh.positions[t[k]]), soup.normals.push_back(mesh.normals[t[k]]), soup.uv.push_back(mesh.uv[t[k]]);
          t[k] = static_cast<std::uint32_t>(soup.positions.size() - 1);
        }
      mesh = std::move(soup);
    }
    if (mesh.parts.size() > 1) return;
    std::vector<std::size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    const auto triangles = mesh.triangles;
    const auto was = right;
    for (std::size_t k = 0; k < order.size(); ++k) mesh.triangles[k] = triangles[order[k]], right[k] = was[order[k]];
  }
};

glm::dvec3 faceOf(const Mesh& mesh, std::size_t t) {
  const glm::uvec3& i = mesh.triangles[t];
  const glm::dvec3 a(mesh.positions[i.x]);
  return glm::cross(glm::dvec3(mesh.positions[i.y]) - a, glm::dvec3(mesh.positions[i.z]) - a);
}

/// Triangles that don't go round as they shall, and corners whose normals point against them.
std::size_t wrongAfter(Assembly& a) {
  std::vector<glm::dvec3> before;
  for (std::size_t t = 0; t < a.mesh.triangles.size(); ++t) before.push_back((a.right[t] ? 1.0 : -1.0) * faceOf(a.mesh, t));
  orientShells(a.mesh, true, kCrease);
  std::size_t wrong = 0;
  for (std::size_t t = 0; t < before.size(); ++t) {
    const glm::dvec3 face = faceOf(a.mesh, t);
    if (glm::dot(face, before[t]) <= 0.0) ++wrong;
    for (int k = 0; k < 3; ++k)
      if (glm::dot(face, glm::dvec3(a.mesh.normals[a.mesh.triangles[t][k]])) <= 0.0) ++wrong;
  }
  return wrong;
}

}  // namespace

// Expected: whatever was done to its triangles, each body's outer shell ends outward, the next inward, and so on.
TEST(MeshOrientation, ThousandAssemblies) {
  std::size_t wrong = 0, open = 0, triangles = 0;
  double worst = 0.0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Assembly a;
    a.random.seed(seed);
    const bool oneName = a.toss();
    for (int b = 0, bodies = 1 + static_cast<int>(a.random() % 4); b < bodies; ++b)
      a.addBody({5.0f * static_cast<float>(b), 0.0f, static_cast<float>(a.unit())}, oneName ? "all" : "body " + std::to_string(b));
    a.shuffle();
    triangles += a.mesh.triangles.size();
    wrong += wrongAfter(a);
    open += a.mesh.closed ? 0 : 1;
    worst = std::max(worst, std::abs(signedVolume(a.mesh) / a.volume - 1.0));
  }
  EXPECT_GT(triangles, 100000u);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(open, 0u);
  test::bound("signed volume of 1000 assemblies of shells, mirrored, turned and hollow, against the sum of their shells', relative", worst, 1e-9,
              "sums of doubles over the same vertices, far bodies cancelling");
}

// Bodies that share a corner, an edge, part of a face or a whole face, some of them turned; in one part, and in parts of their own. Expected: three
// cubic metres, closed, each told apart.
TEST(MeshOrientation, BodiesThatTouch) {
  std::size_t closed = 0, cases = 0;
  for (const glm::vec3 step : {glm::vec3(1, 1, 1), glm::vec3(1, 1, 0), glm::vec3(1, 0, 0), glm::vec3(1, 0.5f, 0)})
    for (int turned = 0; turned < 8; ++turned)
      for (const bool ownParts : {false, true}) {
        Assembly a;
        for (int b = 0; b < 3; ++b) {
          const glm::mat4 at = glm::translate(glm::mat4(1.0f), static_cast<float>(b) * step);
          a.add(makeBox(1, 1, 1), at, ownParts ? std::string(1, static_cast<char>('a' + b)) : "all", false, turned >> b & 1 ? 1.0 : 0.0);
        }
        SCOPED_TRACE(std::to_string(step.y) + " " + std::to_string(step.z) + " turned " + std::to_string(turned) + (ownParts ? " own parts" : ""));
        ++cases;
        orientShells(a.mesh, true, kCrease);
        if (!a.mesh.closed) continue;
        ++closed;
        EXPECT_NEAR(signedVolume(a.mesh), 3.0, 1e-12);
      }
  EXPECT_EQ(cases, 64u);
  EXPECT_EQ(closed, 64u);
}

// Heaps of cubes on a lattice, which share corners, edges and faces at random, some of them turned. Expected: never closed with another volume than they
// have; what cannot be told is left open, so that both sides are drawn.
TEST(MeshOrientation, HeapsOfCubes) {
  std::size_t closed = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Assembly a;
    a.random.seed(seed);
    std::set<std::array<int, 3>> taken;
    for (std::size_t cubes = 2 + a.random() % 12; taken.size() < cubes;) {
      const std::array<int, 3> at{static_cast<int>(a.random() % 3), static_cast<int>(a.random() % 3), static_cast<int>(a.random() % 3)};
      if (taken.insert(at).second)
        a.add(makeBox(1, 1, 1), glm::translate(glm::mat4(1.0f), glm::vec3(at[0], at[1], at[2])), "all", false, a.toss(0.3) ? 1.0 : 0.0);
    }
    a.shuffle();
    orientShells(a.mesh, true, kCrease);
    if (!a.mesh.closed) continue;
    ++closed;
    EXPECT_NEAR(signedVolume(a.mesh), static_cast<double>(taken.size()), 1e-9) << seed;
  }
  EXPECT_GE(closed, 250u);  // 284 were found
}

// Two halves of a body, one the other's mirror image with its winding left as it was: one shell, one half of it turned.
TEST(MeshOrientation, MirroredHalves) {
  for (const bool second : {false, true})
    for (const int segments : {5, 8, 13}) {
      Mesh half = makeCone(1.0, 0.4, 2.0, segments, true);
      // Its base, at x = -1, is left out, and stands on the mirror.
      std::erase_if(half.triangles, [&](const glm::uvec3& t) { return half.positions[t.x].x < 0 && half.positions[t.y].x < 0 && half.positions[t.z].x < 0; });
      half.parts[0].triangleCount = static_cast<std::uint32_t>(half.triangles.size());
      for (glm::vec3& p : half.positions) p.x += 1.0f;
      Mesh other = half;
      for (glm::vec3& p : other.positions) p.x = -p.x;
      for (glm::vec3& n : other.normals) n.x = -n.x;
      Mesh whole;
      appendPart(whole, second ? other : half, "all", glm::mat4(1.0f));
      appendPart(whole, second ? half : other, "all", glm::mat4(1.0f));
      orientShells(whole, true, kCrease);
      EXPECT_TRUE(whole.closed);
      // Twice a frustum over regular polygons: h/3 (A + sqrt(A B) + B).
      const double base = 0.5 * segments * std::sin(2.0 * kPi / segments);
      EXPECT_NEAR(signedVolume(whole), 2.0 * 2.0 / 3.0 * base * (1.0 + 0.4 + 0.16), 1e-5);
      EXPECT_EQ(whole.notes.size(), 1u);
    }
}

// Open sheets keep the winding that most of them has; a Moebius strip has none, and stays as it is. Neither is closed.
TEST(MeshOrientation, OpenAndOneSidedSheets) {
  Mesh plate = makePlate(2.0, 2.0, 4, 4);
  for (const std::size_t t : {3u, 10u, 17u}) std::swap(plate.triangles[t].x, plate.triangles[t].y);
  orientShells(plate, true, kCrease);
  for (std::size_t t = 0; t < plate.triangles.size(); ++t) EXPECT_GT(faceOf(plate, t).x, 0.0);
  for (const glm::vec3& n : plate.normals) EXPECT_EQ(n, glm::vec3(1, 0, 0));
  EXPECT_FALSE(plate.closed);
  ASSERT_EQ(plate.notes.size(), 1u);
  EXPECT_EQ(plate.notes[0], "3 triangles went round another way than those beside, and were turned");
  Mesh turned = makePlate(2.0, 2.0, 3, 3);
  for (glm::uvec3& t : turned.triangles) std::swap(t.x, t.y);
  for (glm::vec3& n : turned.normals) n = -n;
  const auto triangles = turned.triangles;
  orientShells(turned, true, kCrease);
  EXPECT_EQ(turned.triangles, triangles);
  EXPECT_TRUE(turned.notes.empty());

  Mesh strip;
  constexpr int kPieces = 24;
  for (int i = 0; i < kPieces; ++i) {
    const double a = 2.0 * kPi * i / kPieces;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1.0 + side * std::cos(0.5 * a);
      strip.positions.emplace_back(r * std::cos(a), r * std::sin(a), side * std::sin(0.5 * a));
      strip.normals.emplace_back(0, 0, 1), strip.uv.emplace_back(0, 0);
    }
  }
  for (std::uint32_t i = 0; i < kPieces; ++i) {
    const bool last = i + 1 == kPieces;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.emplace_back(a, c, b), strip.triangles.emplace_back(b, c, d);
  }
  strip.parts = {{"all", 0, static_cast<std::uint32_t>(strip.triangles.size())}};
  const auto before = strip.triangles;
  orientShells(strip, false, kCrease);
  EXPECT_EQ(strip.triangles, before);
  EXPECT_FALSE(strip.closed);
}

// A fin that stands on a closed body is a sheet of its own: the body still faces outward, and the mesh as a whole is open.
TEST(MeshOrientation, AFinOnABody) {
  for (const bool turned : {false, true}) {
    Assembly a;
    a.add(makeBox(1, 1, 1), glm::mat4(1.0f), "all", false, turned ? 1.0 : 0.0);
    const auto n = static_cast<std::uint32_t>(a.mesh.positions.size());
    for (const glm::vec3 p : {glm::vec3(0.5f, 0.5f, 0.5f), {0.5f, -0.5f, 0.5f}, {0.5f, 0.0f, 2.0f}})
      a.mesh.positions.push_back(p), a.mesh.normals.emplace_back(1, 0, 0), a.mesh.uv.emplace_back(0, 0);
    a.mesh.triangles.emplace_back(n, n + 1, n + 2);
    ++a.mesh.parts[0].triangleCount;
    orientShells(a.mesh, true, kCrease);
    EXPECT_FALSE(a.mesh.closed);
    for (std::size_t t = 0; t + 1 < a.mesh.triangles.size(); ++t)
      EXPECT_GT(glm::dot(faceOf(a.mesh, t), glm::dvec3(a.mesh.positions[a.mesh.triangles[t].x]) + glm::dvec3(a.mesh.positions[a.mesh.triangles[t].y])), 0.0);
  }
}

// Normals that point inwards are made anew where the winding is right; where the winding was wrong with them they are turned with it, and stay as smooth.
TEST(MeshOrientation, NormalsFollowTheSurface) {
  for (const bool winding : {false, true})
    for (const bool normals : {false, true})
      for (const bool some : {false, true}) {
        Mesh sphere = makeSphere(1.0, 16);
        if (winding)
          for (glm::uvec3& t : sphere.triangles) std::swap(t.x, t.y);
        for (std::size_t i = 0; i < sphere.normals.size(); ++i)
          if (normals && (!some || i % 3 == 0)) sphere.normals[i] = -sphere.normals[i];
        orientShells(sphere, true, kCrease);
        EXPECT_TRUE(sphere.closed);
        EXPECT_GT(signedVolume(sphere), 0.0);
        double worst = 1.0;
        for (std::size_t i = 0; i < sphere.positions.size(); ++i)
          worst = std::min(worst, static_cast<double>(glm::dot(glm::normalize(sphere.positions[i]), sphere.normals[i])));
        EXPECT_GT(worst, 0.99);
        EXPECT_EQ(sphere.notes.size(), (winding ? 1u : 0u) + (normals && !(winding && !some) ? 1u : 0u));
      }
}

// A body within another of other parts that is wound like it is told and stays what it is; wound against it, it is a hollow's wall.
TEST(MeshOrientation, ABodyWithinAnother) {
  for (const bool against : {false, true})
    for (const bool allTurned : {false, true}) {
      Assembly a;
      a.add(makeSphere(2.0, 12), glm::mat4(1.0f), "canopy", false, allTurned ? 1.0 : 0.0);
      a.add(makeBox(0.5, 0.5, 0.5), glm::mat4(1.0f), "pilot", against, allTurned != against ? 1.0 : 0.0);
      orientShells(a.mesh, true, kCrease);
      EXPECT_TRUE(a.mesh.closed);
      EXPECT_NEAR(signedVolume(a.mesh), signedVolume(makeSphere(2.0, 12)) + (against ? -0.125 : 0.125), 1e-5);
      const bool told =
          std::any_of(a.mesh.notes.begin(), a.mesh.notes.end(), [](const std::string& n) { return n.find("'pilot' lies within one of 'canopy'") != n.npos; });
      EXPECT_EQ(told, !against);
    }
}

}  // namespace pitviper
