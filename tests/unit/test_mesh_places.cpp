// Where the vertices of meshes from files are: far from their file's origin, moved and mirrored by nodes; and text that other programs write otherwise.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/scene/mesh_cache.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/primitives.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/mesh_import.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

using MeshPlaces = test::MeshImport;

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", v);
  return text;
}

/// Corners of triangles that hang together by index.
struct Shape {
  std::vector<glm::dvec3> places;
  std::vector<glm::uvec3> triangles;
};

std::string objOf(const Shape& s) {
  std::string text = "v 0 0 0\n";  // no face has it
  for (const glm::dvec3& p : s.places) text += "v " + number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
  for (const glm::uvec3& t : s.triangles) text += "f " + std::to_string(t.x + 2) + " " + std::to_string(t.y + 2) + " " + std::to_string(t.z + 2) + "\n";
  return text;
}

std::string stlOf(const Shape& s) {
  std::string text = "solid far\n";
  for (const glm::uvec3& t : s.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) text += "vertex " + number(s.places[t[k]].x) + " " + number(s.places[t[k]].y) + " " + number(s.places[t[k]].z) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid far\n";
}

std::string plyOf(const Shape& s, bool ascii) {
  std::string out = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") + " 1.0\nelement vertex " + std::to_string(s.places.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " + std::to_string(s.triangles.size()) +
                    "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const glm::dvec3& p : s.places) {
    if (ascii) out += number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
    else put(p.x), put(p.y), put(p.z);
  }
  for (const glm::uvec3& t : s.triangles) {
    if (ascii) out += "3 " + std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z) + "\n";
    else put(std::uint8_t{3}), put(t.x), put(t.y), put(t.z);
  }
  return out;
}

std::string vtpOf(const Shape& s) {
  std::string points, faces, ends;
  for (const glm::dvec3& p : s.places) points += number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    faces += std::to_string(s.triangles[t].x) + " " + std::to_string(s.triangles[t].y) + " " + std::to_string(s.triangles[t].z) + " ";
    ends += std::to_string(3 * t + 3) + " ";
  }
  return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"" + std::to_string(s.places.size()) +
         "\" NumberOfPolys=\"" + std::to_string(s.triangles.size()) + "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" +
         points + "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" + faces +
         "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" + ends + "</DataArray></Polys></Piece></PolyData></VTKFile>\n";
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto b = [&](std::size_t k) { return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0u; };
    const unsigned bits = b(0) << 16 | b(1) << 8 | b(2);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63u];
  }
  return out;
}

/// One mesh under nodes written as JSON; all of them stand in the scene's list that nobody has as a child.
std::string gltfOf(const Mesh& mesh, const std::string& nodes, const std::string& tops) {
  std::string bytes;
  const auto put = [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); };
  const std::size_t n = mesh.positions.size(), t = mesh.triangles.size();
  put(mesh.positions.data(), 12 * n), put(mesh.normals.data(), 12 * n), put(mesh.triangles.data(), 12 * t);
  const auto text = [](std::size_t v) { return std::to_string(v); };
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [)" + tops + R"(]}], "nodes": [)" + nodes +
         R"(], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}], "accessors": [
{"bufferView": 0, "componentType": 5126, "count": )" +
         text(n) + R"(, "type": "VEC3"}, {"bufferView": 1, "componentType": 5126, "count": )" + text(n) +
         R"(, "type": "VEC3"}, {"bufferView": 2, "componentType": 5125, "count": )" + text(3 * t) + R"(, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": )" +
         text(12 * n) + R"(}, {"buffer": 0, "byteOffset": )" + text(12 * n) + R"(, "byteLength": )" + text(12 * n) + R"(}, {"buffer": 0, "byteOffset": )" +
         text(24 * n) + R"(, "byteLength": )" + text(12 * t) + R"(}],
"buffers": [{"byteLength": )" +
         text(bytes.size()) + R"(, "uri": "data:application/octet-stream;base64,)" + base64(bytes) + "\"}]}";
}

/// Triangles whose normals, of corners or by winding, don't point away from the middle of their part.
std::size_t inwardOf(const Mesh& mesh) {
  std::size_t inward = 0;
  for (const MeshPart& part : mesh.parts) {
    glm::dvec3 middle(0.0);
    for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t)
      for (int k = 0; k < 3; ++k) middle += glm::dvec3(mesh.positions[mesh.triangles[t][k]]) / (3.0 * part.triangleCount);
    for (std::uint32_t t = part.firstTriangle; t < part.firstTriangle + part.triangleCount; ++t) {
      const glm::uvec3& i = mesh.triangles[t];
      const glm::dvec3 a(mesh.positions[i.x]), b(mesh.positions[i.y]), c(mesh.positions[i.z]), face = glm::cross(b - a, c - a),
                                                                                               out = (a + b + c) / 3.0 - middle;
      bool wrong = glm::dot(face, out) <= 0.0;
      for (int k = 0; k < 3; ++k) wrong |= glm::dot(glm::dvec3(mesh.normals[i[k]]), face) < 0.3 * glm::length(face);
      inward += wrong ? 1 : 0;
    }
  }
  return inward;
}

}  // namespace

// Bodies of 0.1 to 300 m at 1e3 to 1e7 m from their file's origin, in every format that has text or doubles. Expected: each vertex where the file has it, to
// what single precision of the body's own size gives.
TEST_F(MeshPlaces, FarFromTheFilesOrigin) {
  std::mt19937_64 random(11);
  const auto unit = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  double worst = 0.0, worstFrom = 0.0;
  for (double away = 1e3; away < 2e7; away *= 10.0)
    for (int form = 0; form < 5; ++form) {
      const double size = std::min(0.1 * std::pow(3000.0, unit()), 0.05 * away);
      const glm::dvec3 at = away * glm::normalize(glm::dvec3(unit() - 0.5, unit() - 0.5, unit() - 0.5));
      Shape shape;
      const Mesh sphere = makeSphere(0.5, 8);
      for (const glm::vec3& p : sphere.positions) shape.places.push_back(at + size * (glm::dvec3(p) + 1e-3 * unit()));
      shape.triangles = sphere.triangles;
      const Mesh mesh = form == 0   ? import("far.obj", objOf(shape))
                        : form == 1 ? import("far.stl", stlOf(shape))
                        : form == 2 ? import("far.ply", plyOf(shape, true))
                        : form == 3 ? import("far.ply", plyOf(shape, false))
                                    : import("far.vtp", vtpOf(shape));
      ASSERT_EQ(mesh.triangles.size(), shape.triangles.size());
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
          const glm::dvec3 place = mesh.offset_m + glm::dvec3(mesh.positions[mesh.triangles[t][k]]);
          // STL's points are merged and its triangles may begin anywhere.
          double nearest = INFINITY;
          for (int c = 0; c < 3; ++c) nearest = std::min(nearest, glm::length(place - shape.places[shape.triangles[t][c]]));
          worst = std::max(worst, nearest / size);
        }
      worstFrom = std::max(worstFrom, boundingSphere(mesh).radius_m / size);
    }
  test::bound("vertices of bodies 1e3 to 1e7 m from their files' origin, off by a share of the body's size", worst, 3e-7,
              "single precision of the size, 2^-24 along each axis, twice rounded; doubles at 1e7 m");
  EXPECT_LT(worstFrom, 1.0);
}

// Coordinates that the file has in single precision stay what they are there, to the last bit: what they are rounded to is not rounded again.
TEST_F(MeshPlaces, SinglePrecisionStaysExact) {
  for (const float away : {1e3f, 65536.5f, 4649776.5f, 9.9e6f}) {
    const Mesh box = makeBox(30, 20, 10);
    std::string bytes(80, ' ');
    const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(static_cast<std::uint32_t>(box.triangles.size()));
    std::vector<glm::vec3> places;
    for (const glm::uvec3& t : box.triangles) {
      put(glm::vec3(0.0f));
      for (int k = 0; k < 3; ++k) places.push_back(box.positions[t[k]] + glm::vec3(away, -0.3f * away, 0.1f)), put(places.back());
      put(std::uint16_t{0});
    }
    const Mesh mesh = import("far.stl", bytes);
    EXPECT_NE(mesh.offset_m, glm::dvec3(0.0));
    ASSERT_EQ(mesh.triangles.size(), box.triangles.size());
    for (const glm::uvec3& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 place = mesh.offset_m + glm::dvec3(mesh.positions[t[k]]);
        EXPECT_TRUE(std::any_of(places.begin(), places.end(), [&](const glm::vec3& p) { return glm::dvec3(p) == place; })) << away;
      }
  }
}

// A body near its file's origin, as nearly all are, has no offset; nor does a large one about it.
TEST_F(MeshPlaces, NearOnesStayAsTheyAre) {
  for (const double away : {0.0, 0.5, 3.0}) {
    Shape shape;
    const Mesh box = makeBox(1, 1, 1);
    for (const glm::vec3& p : box.positions) shape.places.push_back(glm::dvec3(p) + away);
    shape.triangles = box.triangles;
    const Mesh mesh = import("near.obj", objOf(shape));
    EXPECT_EQ(mesh.offset_m, glm::dvec3(0.0));
    EXPECT_TRUE(mesh.closed);
    EXPECT_TRUE(mesh.notes.empty());
  }
}

// Nodes far away, within nodes, turned and scaled: translations of doubles whose sums are the place.
TEST_F(MeshPlaces, NodesInDoublePrecision) {
  const Mesh box = makeBox(1, 1, 1);
  const char* place = R"("translation": [4649776.45, 12.5, 500123.15])";
  struct Case {
    std::string nodes;
    glm::dvec3 middle;  // in the file's axes
  };
  for (const Case& c : {Case{std::string("{\"mesh\": 0, ") + place + "}", {4649776.45, 12.5, 500123.15}},
                        Case{std::string("{\"children\": [1], ") + place + "}, {\"mesh\": 0, \"translation\": [0.1, 0, 0]}", {4649776.55, 12.5, 500123.15}},
                        Case{std::string("{\"children\": [1], \"matrix\": [0,1,0,0, -1,0,0,0, 0,0,1,0, 0,0,0,1]}, {\"mesh\": 0, ") + place + "}",
                             {-12.5, 4649776.45, 500123.15}},
                        Case{std::string("{\"children\": [1], \"scale\": [2, 2, 2]}, {\"mesh\": 0, ") + place + "}", {9299552.9, 25.0, 1000246.3}}}) {
    const Mesh mesh = import("node.gltf", gltfOf(box, c.nodes, "0"));
    const BoundingSphere sphere = boundingSphere(mesh);
    const glm::dvec3 body = mesh.offset_m + sphere.center;
    EXPECT_LT(glm::length(body - glm::dvec3(c.middle.z, c.middle.x, c.middle.y)), 1e-6) << c.nodes;  // z forward, x left, y up
    EXPECT_LT(sphere.radius_m, 2.0);
    EXPECT_TRUE(mesh.closed);
    EXPECT_EQ(inwardOf(mesh), 0u);
  }
}

// Every sign of a scale, by scale and by matrix, under a mirrored parent, beside one that is not: no winding and no normal changes its side, and nothing is
// told.
TEST_F(MeshPlaces, MirroredNodes) {
  const Mesh cone = makeCone(1.0, 0.5, 2.0, 7);
  for (int signs = 0; signs < 8; ++signs) {
    const std::string x = signs & 1 ? "-1" : "1", y = signs & 2 ? "-1.5" : "1.5", z = signs & 4 ? "-2" : "2";
    const std::string byScale =
        "{\"name\": \"a\", \"mesh\": 0, \"translation\": [5, 0, 0], \"rotation\": [0.5, 0.5, 0.5, 0.5], \"scale\": [" + x + "," + y + "," + z + "]}";
    const std::string byMatrix = "{\"name\": \"b\", \"mesh\": 0, \"matrix\": [" + x + ",0,0,0, 0," + y + ",0,0, 0,0," + z + ",0, -5,0,0,1]}";
    const std::string under =
        "{\"children\": [3], \"scale\": [-1, 1, 1]}, {\"name\": \"c\", \"mesh\": 0, \"translation\": [0, 9, 0], \"scale\": [" + x + "," + y + "," + z + "]}";
    const Mesh mesh = import("mirrored.gltf", gltfOf(cone, byScale + "," + byMatrix + "," + under, "0, 1, 2"));
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_TRUE(mesh.closed) << signs;
    EXPECT_EQ(inwardOf(mesh), 0u) << signs;
    EXPECT_NEAR(signedVolume(mesh), 9.0 * signedVolume(cone), 1e-4) << signs;
    EXPECT_TRUE(mesh.notes.empty()) << signs;
  }
  // An open sheet too: its normals keep their side.
  const Mesh plate = import("plate.gltf", gltfOf(makePlate(1, 1), R"({"mesh": 0, "scale": [-1, 1, 1]})", "0"));
  for (const glm::vec3& n : plate.normals) EXPECT_EQ(n, glm::vec3(0, -1, 0));
  const glm::uvec3 i = plate.triangles[0];
  EXPECT_LT(glm::cross(plate.positions[i.y] - plate.positions[i.x], plate.positions[i.z] - plate.positions[i.x]).y, 0.0f);
}

// A mesh of its own place in a scenario: what it carries, what looks at it and what turns it go by its file's origin, vertices by both; and the cache keeps it.
TEST_F(MeshPlaces, OffsetsInAScenario) {
  Shape far, near;
  const Mesh box = makeBox(2, 1, 1);
  const glm::dvec3 at(4649776.2, 500123.4, 100.0);
  for (const glm::vec3& p : box.positions) near.places.emplace_back(p), far.places.push_back(glm::dvec3(p) + at);
  near.triangles = far.triangles = box.triangles;
  const auto nearFile = write("near.obj", objOf(near)), farFile = write("far.obj", objOf(far));
  const auto stateOf = [&](const std::string& file, const glm::dvec3& place) {
    const Simulation sim = test::scene(
        "entities:\n  - {name: m, shape: {model: mesh, file: " + file + ", unit: 0.5 m, scale: 2}, material: blackbody, temperature: 300 K, position: [" +
        number(place.x) + " m, " + number(place.y) + " m, " + number(place.z) + " m], heading: 30 deg, pitch: 20 deg}\n" +
        "  - {name: carried, attached_to: m, shape: {model: sphere, radius: 1 m}, material: blackbody, temperature: 300 K, position: [1 m, 2 m, 3 m]}\n"
        "cameras:\n  - {name: c, film: {width: 4, height: 4}, field_of_view: 3 deg, aperture: 20 mm, position: [0 m, 0 m, 9 m], look_at: m, channels: [{name: "
        "mw, response: {band: [3 um, 5 um]}}]}\n");
    const WorldState state = advance(sim, 0.0);
    const Entity& e = sim.entities[0];
    std::vector<glm::dvec3> places;
    for (const glm::uvec3& t : e.mesh->triangles)
      for (int k = 0; k < 3; ++k) places.push_back(state.entities[0].position + state.entities[0].orientation * glm::dvec3(e.mesh->positions[t[k]]));
    places.push_back(state.bodyPose(0).position);
    places.push_back(state.entities[1].position);
    places.push_back(cameraAt(sim.cameras[0], state).pose.orientation * glm::dvec3(1, 0, 0));
    return std::pair(places, e.mesh->offset_m);
  };
  const auto [plain, none] = stateOf(nearFile.string(), {1.0, 2.0, 3.0});
  EXPECT_EQ(none, glm::dvec3(0.0));
  const glm::dmat3 turn = glm::mat3_cast(orientationFrom({30.0 * 3.14159265358979324 / 180.0, 20.0 * 3.14159265358979324 / 180.0, 0.0}));
  for (int again = 0; again < 2; ++again) {  // the second time from the cache
    const auto [there, offset] = stateOf(farFile.string(), glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_GT(glm::length(offset), 4e6);
    for (std::size_t k = 0; k + 3 < plain.size(); ++k) ASSERT_LT(glm::length(there[k] - (plain[k] + turn * at)), 1e-6) << k;
    for (std::size_t k = plain.size() - 3; k < plain.size(); ++k) EXPECT_LT(glm::length(there[k] - plain[k]), 1e-8);
    setModuleFolder(folder / "nowhere");
  }
  setModuleFolder({});
  Mesh kept = makeBox(1, 1, 1);
  kept.offset_m = at, kept.notes = {"one", "two"};
  const auto back = deserializeMesh(serializeMesh(kept));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->offset_m, at);
  EXPECT_EQ(back->notes, kept.notes);
}

// Text STL as others write it: blanks and empty lines before it, large letters, the mark of UTF-8, no name, two solids.
TEST_F(MeshPlaces, TextStl) {
  Shape tetrahedron;
  tetrahedron.places = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const std::string plain = stlOf(tetrahedron);
  std::string large = plain;
  for (char& c : large) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string windows;
  for (char c : plain) windows += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& text : {plain, "  " + plain, "\n\n\t" + plain, large, " \n" + large, "\xef\xbb\xbf" + plain, "\xef\xbb\xbf \n" + large, windows,
                                  "\r\n" + windows, "Solid" + plain.substr(9), "solid\n" + plain.substr(10)}) {
    const Mesh mesh = import("a.stl", text);
    EXPECT_EQ(mesh.triangles.size(), 4u) << text.substr(0, 30);
    EXPECT_NEAR(signedVolume(mesh), 1.0 / 6.0, 1e-7);
  }
  EXPECT_EQ(import("a.stl", " " + plain + large).triangles.size(), 8u);
  // Text without its first word is told by line; text in UTF-16 for what it is.
  const auto file = write("b.stl", plain.substr(10));
  EXPECT_TRUE(complaint(file).starts_with(file.string() + ":1:1: 'facet' is not possible here; expected 'solid'")) << complaint(file);
  std::string wide = "\xff\xfe";
  for (char c : plain) wide += c, wide += '\0';
  EXPECT_NE(complaint(write("c.stl", wide)).find("byte 0: the text is in UTF-16"), std::string::npos) << complaint(folder / "c.stl");
  // The mark before other text formats: no vertex is lost with the first word.
  EXPECT_EQ(import("a.obj", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").triangles.size(), 1u);
}

}  // namespace pitviper
