#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <set>

#include "scenarios/assets/make_aircraft.hpp"
#include "sim/parameters/module_on_demand.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/mesh_cache.hpp"
#include "sim/scene/mesh_import.hpp"
#include "sim/scene/mesh_normals.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/primitives.hpp"
#include "tests/fuzz/fuzz_mesh.hpp"
#include "tests/support/mesh_import.hpp"
#include "tests/support/write_obj.hpp"

namespace pitviper {
namespace {


/// Regular polygon of n corners inscribed in a circle, over the circle: the closed form of every cap and wall below.
double polygonArea(double radius, int n) { return 0.5 * n * radius * radius * std::sin(2.0 * kPi / n); }

/// Normals are unit and agree with the triangles' winding; parts cover everything.
void expectSound(Mesh mesh, bool closed) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uv.size(), mesh.positions.size());
  const std::size_t triangles = mesh.triangles.size();
  EXPECT_EQ(validateMesh(mesh, {}), 0u);
  EXPECT_EQ(mesh.triangles.size(), triangles);
  EXPECT_EQ(mesh.closed, closed);
  EXPECT_EQ(isClosed(mesh), closed);
  for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
  for (const glm::vec2& t : mesh.uv) ASSERT_TRUE(t.x >= 0.0f && t.x <= 1.0f && t.y >= 0.0f && t.y <= 1.0f);
  std::size_t against = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
    for (int k = 0; k < 3; ++k) against += glm::dot(face, glm::dvec3(mesh.normals[t[k]])) <= 0.0 ? 1 : 0;
  }
  EXPECT_EQ(against, 0u);
}

using Import = test::MeshImport;

}  // namespace

TEST(Primitives, PlateAndDisc) {
  const Mesh plate = makePlate(2.0, 3.0, 4, 5);
  expectSound(plate, false);
  EXPECT_NEAR(surfaceArea(plate), 6.0, 1e-6);
  EXPECT_EQ(plate.triangles.size(), 40u);
  for (const glm::vec3& n : plate.normals) EXPECT_EQ(n, glm::vec3(1, 0, 0));
  const Mesh disc = makeDisc(2.0, 50);
  expectSound(disc, false);
  EXPECT_NEAR(surfaceArea(disc), polygonArea(2.0, 50), 1e-5);
}

TEST(Primitives, Box) {
  const Mesh box = makeBox(2.0, 3.0, 5.0);
  expectSound(box, true);
  EXPECT_TRUE(isClosed(box));
  EXPECT_NEAR(surfaceArea(box), 2.0 * (6.0 + 10.0 + 15.0), 1e-5);
  EXPECT_NEAR(signedVolume(box), 30.0, 1e-5);
  ASSERT_EQ(box.parts.size(), 6u);
  const std::pair<const char*, glm::vec3> sides[] = {{"front", {1, 0, 0}},  {"back", {-1, 0, 0}}, {"left", {0, 1, 0}},
                                                     {"right", {0, -1, 0}}, {"top", {0, 0, 1}},   {"bottom", {0, 0, -1}}};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(box.parts[i].name, sides[i].first);
    EXPECT_EQ(box.normals[box.triangles[box.parts[i].firstTriangle].x], sides[i].second);
  }
}

TEST(Primitives, SphereErrorIsAsDocumented) {
  for (const int n : {4, 5, 17, 64}) expectSound(makeSphere(3.0, n), true);
  for (const int n : {32, 64, 128}) {
    const double missing = 1.0 - surfaceArea(makeSphere(1.0, n)) / (4.0 * kPi);
    EXPECT_NEAR(missing * n * n, 8.2, 0.1) << n;
    EXPECT_NEAR(signedVolume(makeSphere(1.0, n)), 4.0 / 3.0 * kPi, 70.0 / (n * n)) << n;
  }
  const Mesh equal = makeSphere(2.5, 64, SphereFit::EqualArea);
  expectSound(equal, true);
  EXPECT_NEAR(surfaceArea(equal) / (4.0 * kPi * 6.25), 1.0, 1e-6);  // positions are floats
  for (const glm::dvec3 d : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(1, 2, 3))}) {
    double projected = 0.0;
    for (const glm::uvec3& t : equal.triangles) {
      const glm::dvec3 a(equal.positions[t.x]), b(equal.positions[t.y]), c(equal.positions[t.z]);
      projected += 0.25 * std::abs(glm::dot(d, glm::cross(b - a, c - a)));  // front and back count
    }
    EXPECT_NEAR(projected / (kPi * 6.25), 1.0, 3.6 / (64 * 64));
  }
}

TEST(Primitives, CylinderAndCone) {
  const int n = 40;
  const Mesh cylinder = makeCylinder(2.0, 5.0, n);
  expectSound(cylinder, true);
  EXPECT_NEAR(signedVolume(cylinder), 5.0 * polygonArea(2.0, n), 1e-4);
  EXPECT_NEAR(surfaceArea(cylinder), 2.0 * polygonArea(2.0, n) + 5.0 * n * 4.0 * std::sin(kPi / n), 1e-4);
  expectSound(makeCylinder(2.0, 5.0, n, false), false);
  const Mesh frustum = makeCone(2.0, 1.0, 3.0, n);
  expectSound(frustum, true);
  EXPECT_NEAR(signedVolume(frustum), polygonArea(1.0, n) * 3.0 / 3.0 * (4.0 + 2.0 + 1.0), 1e-4);
  for (const auto& [base, top] : {std::pair{1.0, 0.0}, {0.0, 1.0}}) {
    const Mesh cone = makeCone(base, top, 3.0, n);
    expectSound(cone, true);
    EXPECT_NEAR(signedVolume(cone), polygonArea(1.0, n), 1e-5);
    expectSound(makeCone(base, top, 3.0, n, false), false);
  }
}

TEST(Primitives, Terrain) {
  TerrainShape shape;
  shape.columns = 64;
  shape.seed = 5;
  const Mesh terrain = makeTerrain(shape);
  expectSound(terrain, false);
  float low = 1e9f, high = -1e9f;
  for (const glm::vec3& p : terrain.positions) low = std::min(low, p.z), high = std::max(high, p.z);
  EXPECT_GE(low, -25.0f);
  EXPECT_LE(high, 25.0f);
  EXPECT_GT(high - low, 10.0f);
  EXPECT_EQ(makeTerrain(shape).positions, terrain.positions);
  shape.octaves = 3;  // resolved at both densities: the same heights at the same places
  const Mesh coarse = makeTerrain(shape);
  shape.columns = 128;
  const Mesh fine = makeTerrain(shape);
  EXPECT_EQ(coarse.positions[5 * 65 + 7], fine.positions[10 * 129 + 14]);
  shape.seed = 6;
  EXPECT_NE(makeTerrain(shape).positions, fine.positions);
  // A slanted plane: exact normals everywhere.
  const Mesh plane = makeTerrain(2.0, 2, 1, {0, 1, 2, 0, 1, 2});
  for (const glm::vec3& n : plane.normals) EXPECT_NEAR(glm::distance(n, glm::normalize(glm::vec3(-1, 0, 1))), 0.0f, 1e-6f);
}

TEST(Primitives, RefuseImpossibleArguments) {
  EXPECT_THROW(makePlate(0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(makeSphere(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(makeSphere(1.0, 1'000'000), std::invalid_argument);
  EXPECT_THROW(makeCone(0.0, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(makeTerrain(1.0, 2, 2, {0.0f}), std::invalid_argument);
}

TEST(MeshTools, NormalsSplitAtCreases) {
  Mesh cylinder = makeCylinder(1.0, 2.0, 32);
  computeNormals(cylinder, 30.0 * kPi / 180.0);
  expectSound(cylinder, true);
  for (std::size_t i = 0; i < cylinder.positions.size(); ++i) {
    const glm::vec3 p = cylinder.positions[i], n = cylinder.normals[i];
    const bool cap = std::abs(n.x) > 0.5f;
    EXPECT_NEAR(glm::dot(n, cap ? glm::vec3(std::copysign(1.0f, p.x), 0, 0) : glm::vec3(0, p.y, p.z)), 1.0f, 1e-5f);
  }
  computeNormals(cylinder, kPi);  // no creases: the rim is rounded
  for (std::size_t i = 0; i < cylinder.positions.size(); ++i)
    if (glm::length(glm::vec2(cylinder.positions[i].y, cylinder.positions[i].z)) > 0.5f) {
      EXPECT_LT(std::abs(cylinder.normals[i].x), 0.99f);
    }
}

TEST(MeshTools, AppendMovesAndMirrors) {
  Mesh both;
  glm::mat4 mirror = glm::translate(glm::mat4(1.0f), glm::vec3(5, 0, 0));
  mirror[1][1] = -2.0f;
  appendPart(both, makeCone(1.0, 0.5, 2.0, 24), "a", glm::mat4(1.0f));
  appendPart(both, makeCone(1.0, 0.5, 2.0, 24), "b", mirror);
  appendPart(both, makeSphere(0.1, 8), "b", glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 9)));
  expectSound(both, true);
  ASSERT_EQ(both.parts.size(), 2u);
  EXPECT_EQ(both.parts[1].name, "b");
  EXPECT_EQ(both.parts[0].triangleCount + both.parts[1].triangleCount, both.triangles.size());
  EXPECT_NEAR(signedVolume(both), 3.0 * signedVolume(makeCone(1.0, 0.5, 2.0, 24)) + signedVolume(makeSphere(0.1, 8)), 1e-4);
  const BoundingSphere sphere = boundingSphere(both);
  for (const glm::vec3& p : both.positions) EXPECT_LE(glm::distance(glm::dvec3(p), sphere.center), sphere.radius_m * (1 + 1e-12));
  EXPECT_LT(sphere.radius_m, 1.2 * 5.8);
  appendPart(both, makePlate(1, 1), "open", glm::mat4(1.0f));
  EXPECT_FALSE(both.closed);
}

TEST(MeshTools, ValidateFindsWhatIsWrong) {
  const Mesh sound = makePlate(1, 1);
  Mesh bad = sound;
  bad.positions[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(validateMesh(bad, {}), UserError);
  bad = sound;
  bad.triangles[0].z = 77;
  EXPECT_THROW(validateMesh(bad, {}), UserError);
  bad = sound;
  bad.triangles.clear();
  EXPECT_THROW(validateMesh(bad, {}), UserError);
  bad = sound;
  bad.triangles.emplace_back(1, 1, 2);
  bad.parts.push_back({"nothing", 2, 1});
  EXPECT_EQ(validateMesh(bad, {}), 1u);
  EXPECT_EQ(bad.parts.size(), 1u);
  Mesh insideOut = makeSphere(1.0, 8);
  for (glm::uvec3& t : insideOut.triangles) std::swap(t.x, t.y);
  EXPECT_FALSE(isClosed(insideOut));
}

TEST(Aircraft, AreClosedAndHaveTheirSize) {
  const Mesh jet = makeJet(), missile = makeMissile();
  for (const Mesh* mesh : {&jet, &missile}) {
    EXPECT_TRUE(mesh->closed);
    EXPECT_TRUE(isClosed(*mesh));
    EXPECT_GT(mesh->triangles.size(), 3000u);
    EXPECT_LT(mesh->triangles.size(), 20000u);
    EXPECT_LT(test::writeObj(*mesh).size(), 1'500'000u);
  }
  const auto extent = [](const Mesh& mesh, int axis) {
    float low = 1e9f, high = -1e9f;
    for (const glm::vec3& p : mesh.positions) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
    return high - low;
  };
  EXPECT_NEAR(extent(jet, 0), 15.1f, 0.1f);
  EXPECT_NEAR(extent(jet, 1), 10.45f, 0.1f);
  EXPECT_NEAR(extent(missile, 0), 2.9f, 0.02f);
  std::vector<std::string> names;
  for (const MeshPart& part : jet.parts) names.push_back(part.name);
  EXPECT_EQ(names, (std::vector<std::string>{"skin", "wing_edges", "radome", "canopy", "intake", "tailpipe", "nozzle"}));
  EXPECT_EQ(missile.parts.size(), 4u);
}

#ifdef PITVIPER_SOURCE_DIR
TEST_F(Import, StoredAircraftAreTheOnesMade) {
  for (const auto& [name, mesh] : {std::pair{"jet.obj", makeJet()}, {"missile.obj", makeMissile()}}) {
    const Mesh stored = importMesh(std::filesystem::path(PITVIPER_SOURCE_DIR) / "scenarios/assets" / name, 1.0, {});
    expectSound(stored, true);
    EXPECT_EQ(stored.triangles.size(), mesh.triangles.size());
    EXPECT_NEAR(surfaceArea(stored) / surfaceArea(mesh), 1.0, 1e-4);
    ASSERT_EQ(stored.parts.size(), mesh.parts.size());
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) EXPECT_EQ(stored.parts[i].name, mesh.parts[i].name);
  }
}
#endif

TEST_F(Import, EveryFormatGivesTheTetrahedron) {
  for (const std::filesystem::path& file : writeSoundMeshes(folder / "sound")) {
    SCOPED_TRACE(file);
    if (file.extension() == ".obj") continue;  // has an open quad besides
    const Mesh mesh = importMesh(file, 2.0, {});
    EXPECT_EQ(mesh.triangles.size(), 4u);
    expectSound(mesh, true);
    EXPECT_NEAR(signedVolume(mesh), 8.0 / 6.0, 1e-5);
    ASSERT_EQ(mesh.parts.size(), 1u);
    const bool isGltf = file.extension() == ".gltf" || file.extension() == ".glb";
    EXPECT_EQ(mesh.parts[0].name, isGltf ? "hull" : "all");
    float front = -1e9f;
    for (const glm::vec3& p : mesh.positions) front = std::max(front, p.x);
    EXPECT_FLOAT_EQ(front + static_cast<float>(mesh.offset_m.x), isGltf ? 22.0f : 2.0f);  // glTF's z, moved by its node, is our x
  }
}

TEST_F(Import, ObjKeepsPartsNormalsAndUv) {
  const Mesh missile = makeMissile();
  const Mesh back = importMesh(write("missile.obj", test::writeObj(missile)), 1.0, {});
  expectSound(back, true);
  ASSERT_EQ(back.parts.size(), missile.parts.size());
  for (std::size_t i = 0; i < back.parts.size(); ++i) {
    EXPECT_EQ(back.parts[i].name, missile.parts[i].name);
    EXPECT_EQ(back.parts[i].triangleCount, missile.parts[i].triangleCount);
  }
  EXPECT_NEAR(surfaceArea(back) / surfaceArea(missile), 1.0, 1e-4);  // five digits
  const glm::uvec3 t = missile.triangles[100], u = back.triangles[100];
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(glm::distance(missile.positions[t[k]], back.positions[u[k]]), 0.0f, 1e-4f);
    EXPECT_NEAR(glm::distance(missile.normals[t[k]], back.normals[u[k]]), 0.0f, 1e-4f);
    EXPECT_NEAR(glm::distance(missile.uv[t[k]], back.uv[u[k]]), 0.0f, 1e-4f);
  }
}

TEST_F(Import, ObjGroupsPolygonsAndGaps) {
  const Mesh mesh = importMesh(writeSoundMeshes(folder / "sound").front(), 1.0, {});
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0].name, "base plate");
  EXPECT_EQ(mesh.parts[1].name, "sides");
  EXPECT_EQ(mesh.parts[1].triangleCount, 5u);  // three and a quad on a joined line
  // A concave polygon (an arrow head of area 1) is cut by ears, not by a fan; many corners on one line are no trouble.
  EXPECT_NEAR(surfaceArea(importMesh(write("arrow.obj", "v 1 0 0\nv 0 2 0\nv 0.5 0 0\nv 0 -2 0\nf 1 2 3 4\n"), 1.0, {})), 1.0, 1e-6);
  std::string ring, face = "f";
  for (int i = 0; i < 1024; ++i) {
    ring += "v " + std::to_string(std::cos(2 * kPi * i / 1024)) + " " + std::to_string(std::sin(2 * kPi * i / 1024)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  EXPECT_NEAR(surfaceArea(importMesh(write("ring.obj", ring + face + "\n"), 1.0, {})), polygonArea(1.0, 1024), 1e-4);
}

TEST_F(Import, MistakesAreNamedWithTheirPlace) {
  const auto starts = [&](const std::string& text, const std::string& start) { EXPECT_TRUE(text.starts_with(start)) << text; };
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  auto file = write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
  starts(complaint(file), file.string() + ":2:5: 'nan' is not a finite number");
  file = write("range.obj", vertices + "f 1 2 4\n");
  starts(complaint(file), file.string() + ":4:7: index 4 is out of range");
  file = write("zero.obj", vertices + "f 1 2 0\n");
  starts(complaint(file), file.string() + ":4:7: index 0 is out of range");
  file = write("flat.obj", vertices + "f 1 2 2\n");
  starts(complaint(file), file.string() + ": every triangle of the mesh has zero area");
  file = write("huge.obj", "v 1e39 0 0\n");
  starts(complaint(file), file.string() + ":1:3: '1e39'");
  file = write("short.stl", std::string(80, ' ') + std::string("\xff\xff\xff\x0f", 4) + std::string(50, '\0'));
  starts(complaint(file), file.string() + ": byte 80: 268435455 triangles need");
  file = write("list.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
  starts(complaint(file), file.string() + ":13:7: '3' is not possible here");
  file = write("bad.gltf", "{\"asset\": {\"version\": \"2.0\"},\n \"buffers\": [{\"byteLength\": 10}]}");
  starts(complaint(file), file.string() + ":2:14: a buffer has no content");
  file = write("bad.vtp", "<VTKFile type=\"PolyData\">\n<Piece NumberOfPoints=\"9999999999\">");
  starts(complaint(file), file.string() + ":2:1: NumberOfPoints");
  starts(complaint(write("a.step", "x")), "scene.yaml:7:3: the mesh file");
  starts(complaint(folder / "missing.obj"), "scene.yaml:7:3: cannot read the file '" + (folder / "missing.obj").string() + "': No such file");
  starts(complaint(write("empty.obj", "")), (folder / "empty.obj").string() + ": the file is empty");
  starts(complaint(write("t.obj", vertices + "f 1 2 3\n"), -1.0), "scene.yaml:7:3: metres per unit");
}

TEST_F(Import, KnownFilesNeedNoModule) {
  const auto file = write("a.obj", test::writeObj(makeSphere(1.0, 16)));
  const Mesh first = importMesh(file, 1.0, {});
  const auto cached = [&] {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(cacheFolder())) found.push_back(entry.path());
    return found;
  };
  ASSERT_EQ(cached().size(), 1u);
  setModuleFolder(folder / "nowhere");
  const Mesh again = importMesh(file, 3.0, {});  // another scale is the same entry
  EXPECT_EQ(again.triangles, first.triangles);
  EXPECT_EQ(again.normals, first.normals);
  EXPECT_NEAR(surfaceArea(again), 9.0 * surfaceArea(first), 1e-4);
  static std::vector<std::string> told;
  told.clear();
  tellOfCacheBy([](const char* line) { told.emplace_back(line); });
  std::filesystem::resize_file(cached()[0], 100);  // damaged: said, read again, and mended
  EXPECT_NE(complaint(file).find("libvtk9-dev"), std::string::npos);
#ifdef PITVIPER_MESH_IMPORT_FOLDER
  setModuleFolder(PITVIPER_MESH_IMPORT_FOLDER);
#else
  setModuleFolder({});
#endif
  EXPECT_EQ(importMesh(file, 1.0, {}).triangles, first.triangles);
  EXPECT_GT(std::filesystem::file_size(cached()[0]), 100u);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find(" is damaged and was removed; pictures are the same without it"), std::string::npos) << told[0];
  setenv("XDG_CACHE_HOME", "/proc/unwritable", 1);
  tellOfCacheBy([](const char* line) { told.emplace_back(line); });
  EXPECT_EQ(importMesh(file, 1.0, {}).triangles, first.triangles);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_NE(told[1].find("/proc/unwritable/pitviper is of no use: "), std::string::npos) << told[1];
  tellOfCacheBy(nullptr);
}

/// A tetrahedron whose buffer is in a file, named as it is written in JSON.
std::string gltfNaming(const std::string& uri) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "h\"ull", "mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4, "material": 0}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}], "images": [{"uri": "/dev/zero"}],
"buffers": [{"byteLength": 72, "uri": ")" +
         uri + "\"}]}";
}

std::string tetrahedron(float size) {
  const float corners[12] = {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size};
  const std::uint16_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  std::string bytes(72, '\0');
  std::memcpy(bytes.data(), corners, 48);
  std::memcpy(bytes.data() + 48, faces, 24);
  return bytes;
}

// Rationale: a buffer's name may be written in many ways. Expected: what was kept is used only while every file that the reader read is as it was; images are
// not read at all.
TEST_F(Import, AChangedBufferIsReadAgain) {
  std::filesystem::create_directories(folder / "sub");
  for (const char* uri : {"sub/x.bin", "sub\\/x.bin", "\\u0073ub\\/x.bin", "./sub/../sub/x.bin"}) {
    const auto file = write("a.gltf", gltfNaming(uri));
    write("sub/x.bin", tetrahedron(1));
    const Mesh one = importMesh(file, 1.0, {});
    EXPECT_EQ(one.parts[0].name, "h\"ull");
    write("sub/x.bin", tetrahedron(2));
    EXPECT_NEAR(surfaceArea(importMesh(file, 1.0, {})), 4 * surfaceArea(one), 1e-5) << uri;
    setModuleFolder(folder / "nowhere");  // and it is kept
    EXPECT_NEAR(surfaceArea(importMesh(file, 1.0, {})), 4 * surfaceArea(one), 1e-5) << uri;
    std::filesystem::remove(folder / "sub/x.bin");
    EXPECT_NE(complaint(file), "") << uri;
#ifdef PITVIPER_MESH_IMPORT_FOLDER
    setModuleFolder(PITVIPER_MESH_IMPORT_FOLDER);
#else
    setModuleFolder({});
#endif
  }
}

TEST_F(Import, OnlyPlainFilesAreRead) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink(folder / "pipe", folder / "pipe.obj");
  EXPECT_NE(complaint(folder / "pipe.obj").find("it is a pipe, not a regular file"), std::string::npos) << complaint(folder / "pipe.obj");
  for (const auto& [uri, kind] : {std::pair{"/dev/zero", "a device"}, {"pipe", "a pipe"}, {".", "a folder"}, {"nothing", "No such file"}}) {
    const auto file = write("a.gltf", gltfNaming(uri));
    EXPECT_TRUE(complaint(file).starts_with(file.string() + ":6:")) << complaint(file);
    EXPECT_NE(complaint(file).find(kind), std::string::npos) << complaint(file);
  }
}

TEST_F(Import, TheCacheIsBounded) {
  const auto cache = folder / "cache" / "pitviper";
  std::filesystem::create_directories(cache);
  const auto now = std::filesystem::file_time_type::clock::now();
  for (int k = 0; k < 10; ++k) {
    const auto file = write("cache/pitviper/mesh-" + std::to_string(k), std::string(1000, 'x'));
    std::filesystem::last_write_time(file, now - std::chrono::hours(k));
  }
  write("cache/pitviper/a.plan", std::string(5000, 'x'));
  write("cache/pitviper/.mesh-1.0123456789abcdef.partial", "half");
  pruneCache(cache, "mesh-", 4500, cache / "mesh-9");
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(cache)) left.insert(entry.path().filename().string());
  EXPECT_EQ(left, (std::set<std::string>{"a.plan", "mesh-0", "mesh-1", "mesh-2", "mesh-9"}));  // the newest, and the one to keep
}

TEST_F(Import, ABrokenModuleIsNamed) {
  write("libpitviper_mesh_import.so", "no library");
  setModuleFolder(folder);
  EXPECT_NE(complaint(write("a.obj", test::writeObj(makePlate(1, 1)))).find("libvtk9.1"), std::string::npos);
  setModuleFolder({});
}

TEST_F(Import, ACachedMeshIsWholeOrNothing) {
  const Mesh mesh = makeSphere(1.0, 6);
  const std::string bytes = serializeMesh(mesh);
  const std::optional<Mesh> back = deserializeMesh(bytes);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->positions, mesh.positions);
  EXPECT_EQ(back->parts[0].name, "all");
  EXPECT_TRUE(back->closed);
  for (std::size_t size = 0; size < bytes.size(); size += 7) EXPECT_FALSE(deserializeMesh(std::string_view(bytes).substr(0, size)));
  for (std::size_t i = 0; i < bytes.size(); i += 11) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    EXPECT_FALSE(deserializeMesh(damaged)) << i;
  }
}

TEST_F(Import, DamagedFilesAreMeshesOrUserErrors) { EXPECT_EQ(fuzzMeshes(1, 150, folder / "fuzz"), 0); }

}  // namespace pitviper
