// Triangles without area: in what is seen, what casts shadows, panes and media. The readers of files drop them; a mesh made in code may hold them.
#include "sim/scene/primitives.hpp"
#include "sim/scene/triangle_tree.hpp"
#include "tests/extremes/extremes.hpp"
#include "tests/support/fog_world.hpp"

namespace pitviper::test {
namespace {

constexpr const char* kModes[] = {"render: {mode: direct}\n", "render: {mode: buffered}\n", "accuracy: reference\n"};

/// The same mesh with triangles of no area strewn between its own: a point, an edge back and forth, three corners on a line.
std::shared_ptr<const Mesh> withSlivers(const Mesh& mesh) {
  auto made = std::make_shared<Mesh>(mesh);
  made->triangles.clear();
  for (const glm::uvec3& t : mesh.triangles) {
    made->triangles.push_back({t.x, t.x, t.x});
    made->triangles.push_back(t);
    made->triangles.push_back({t.x, t.y, t.x});
    const auto middle = static_cast<std::uint32_t>(made->positions.size());
    made->positions.push_back(0.5f * (mesh.positions[t.y] + mesh.positions[t.z]));
    made->normals.push_back(mesh.normals[t.y]);
    made->uv.push_back(mesh.uv[t.y]);
    made->triangles.push_back({t.y, middle, t.z});
  }
  made->parts = {{"all", 0, static_cast<std::uint32_t>(made->triangles.size())}};
  return made;
}

Frame finite(const Simulation& sim) {
  Frame f = renderFrame(sim);
  for (const auto& l : f.layers)
    for (float v : l.pixels) EXPECT_TRUE(std::isfinite(v)) << l.name;
  return f;
}

// Solid, pane and medium, lit, shading each other: the picture is the same, bit for bit or to the last one.
TEST(ZeroArea, TrianglesChangeNothing) {
  Range same("pictures with zero-area triangles strewn in, against without", 1e-6, "the same triangles and formulas");
  const std::string yaml =
      "sun: {azimuth: 60 deg, elevation: 30 deg, irradiance: 10 W/(m2 um)}\nlights: [{name: l, intensity: 50 W/(sr um), visible: false, position: [3 m, 2 m, 1 "
      "m]}]\n"
      "entities:\n  - {name: wall, shape: {model: plate, width: 6 m, height: 6 m}, material: white_lambertian, temperature: 300 K}\n"
      "  - {name: ball, shape: {model: sphere, radius: 0.7 m, segments: 16}, material: white_lambertian, temperature: 320 K, position: [1.5 m, 0.5 m, 0 m]}\n";
  const std::string pane =
      "  - {name: pane, shape: {model: plate, width: 2 m, height: 2 m}, material: {transmission: {transmittance: 0.5}}, temperature: 350 K, position: [3 m, "
      "0.3 m, 0.2 m]}\n"
      "  - {name: fog, shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: {absorption: 1 /m}, temperature: 400 K, position: [4 m, -0.7 m, "
      "0.3 m]}\n";
  for (const char* mode : kModes) {
    const bool direct = mode == kModes[0];
    Simulation sim = scene(mode + yaml + (direct ? "" : pane) +
                           Look{.pixels = 25, .field_deg = 30, .more = "small_bodies: 0, truth: [range, normal, temperature], "}.yaml());
    const Frame without = finite(sim);
    for (Entity& e : sim.entities) e.mesh = withSlivers(*e.mesh);
    const Frame with = finite(sim);
    int coloured = 0;
    for (size_t l = 0; l < with.layers.size(); ++l)
      for (size_t p = 0; p < with.layers[l].pixels.size(); ++p) {
        coloured += without.layers[l].pixels[p] != 0.0f;
        same.add(static_cast<double>(with.layers[l].pixels[p]), static_cast<double>(without.layers[l].pixels[p]),
                 std::string(mode) + with.layers[l].name + " " + std::to_string(p));
      }
    EXPECT_GT(coloured, 1000);
  }
}

// Nothing but triangles without area: nothing is seen, nothing is hidden, nothing is shaded.
TEST(ZeroArea, NothingElse) {
  for (const char* mode : kModes) {
    Simulation sim = scene(
        mode +
        std::string("sun: {azimuth: 90 deg, elevation: 0 deg, irradiance: 10 W/(m2 um)}\nentities:\n"
                    "  - {name: wall, shape: {model: plate, width: 6 m, height: 6 m}, material: white_lambertian, temperature: 0 K}\n"
                    "  - {name: line, shape: {model: plate, width: 6 m, height: 6 m}, material: blackbody, temperature: 900 K, position: [2 m, 0 m, 0 m]}\n") +
        Look{.from = "[9 m, 1 m, 0 m]", .pixels = 25, .field_deg = 20, .more = "small_bodies: 0, "}.yaml());
    auto flat = std::make_shared<Mesh>(*sim.entities[1].mesh);
    for (glm::vec3& p : flat->positions) p.z = 0.0f;
    sim.entities[1].mesh = flat;
    const Frame f = finite(sim);
    for (float v : f.layers[0].pixels) EXPECT_NEAR(static_cast<double>(v) / (40.0 / 3.14159265358979), 1.0, 1e-5) << mode;
  }
}

// A cone with a tip, its upper ring one point; a ray down its axis, along a diagonal, through corners.
TEST(ZeroArea, MediaMetAtTheirEdges) {
  const TemporaryFolder folder;
  const Cloud cube = meshed(folder.put("cube.obj", prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}})), {{{0, 0, 0}, {1, 1, 1}}});
  Range edges("meshed medium met on diagonals and through corners, in double", 2e-5, "chord by hand; bins of 5 1/cm");
  const double b = B(400);
  struct Case {
    glm::dvec3 from, at;
    double chord;
  };
  for (const Case& c : {Case{{9, 0.5, 0.5}, {0, 0.5, 0.5}, 1.0},
                        {{-9, 0.25, 0.25}, {0, 0.25, 0.25}, 1.0},
                        {{9, 9, 9}, {0, 0, 0}, std::sqrt(3.0)},
                        {{5, 5, 0.5}, {0, 0, 0.5}, std::sqrt(2.0)},
                        {{0.5, 5, 5}, {0.5, 0, 0}, std::sqrt(2.0)}}) {
    Cloud fog = cube;
    fog.absorption = 1.0, fog.heading = 90.0;
    const std::string yaml = "entities:\n" + fog.yaml("fog") +
                             Look{.from = "[" + text(c.from.x) + " m, " + text(c.from.y) + " m, " + text(c.from.z) + " m]",
                                  .at = "[" + text(c.at.x) + " m, " + text(c.at.y) + " m, " + text(c.at.z) + " m]",
                                  .more = "small_bodies: 0, "}
                                 .yaml();
    edges.add(middle(inDouble(yaml)), -std::expm1(-c.chord) * b, text(c.from));
  }
}

/// A closed body of two tetrahedra or more, and lines through its very corners and edges: what goes in comes out.
TEST(ZeroArea, CrossingsOfAClosedBodyAreEven) {
  int met = 0, lines = 0, odd = 0;
  for (const Mesh& mesh : {makeBox(2, 2, 2), makeSphere(1.0, 8), makeSphere(1.0, 32), makeCone(1.0, 0.0, 2.0, 12), makeCylinder(1.0, 2.0, 16)}) {
    auto along = [&](const glm::dvec3& target, const glm::dvec3& from) {
      int sum = 0, count = 0;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const TriangleMeeting m = meetTriangle(mesh, t, from, target - from);
        if (m.met) sum += m.entering ? 1 : -1, ++count;
      }
      ++lines, met += count > 0;
      odd += sum != 0;
    };
    const glm::dvec3 eyes[] = {{9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {9, 9, 9}, {7, -3, 1}, {-1e6, 2e6, 3}};
    for (const glm::dvec3& eye : eyes)
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        along(a, eye), along(0.5 * (a + b), eye), along(0.25 * a + 0.75 * c, eye), along((a + b + c) / 3.0, eye);
      }
  }
  bound("lines through corners and edges of closed bodies that go in and out a different number of times", odd, 0,
        "of " + std::to_string(lines) + "; ties are broken the same way");
  EXPECT_GT(met, lines / 2);
}

}  // namespace
}  // namespace pitviper::test
