#include "tests/fuzz/fuzz_mesh.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <string_view>

#include "sim/scene/mesh_cache.hpp"
#include "sim/scene/mesh_import.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/primitives.hpp"
#include "tests/fuzz/fuzz_damage.hpp"

namespace pitviper {
namespace {

constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::uint32_t kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

std::string objText() {
  return "# a tetrahedron and a quad\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 0 1.0\nvt 0 0\nvt 1 0\nvt 1 "
         "1\nvn 0 0 1\n"
         "g base plate\nf 1 3 2\ng sides\nf 1/1 2/2 4/3\nf 2//1 3//1 4//1\nf -5/1/1 -2/2/1 -3/3/1\nusemtl paint\nf 1 2 "
         "5 \\\n3\n";
}

std::string asciiStl() {
  std::string text = "solid tetra\n";
  for (const auto& face : kFaces) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (std::uint32_t k : face) {
      char line[80];
      std::snprintf(line, sizeof line, "      vertex %g %g %e\n", static_cast<double>(kCorners[k][0]), static_cast<double>(kCorners[k][1]),
                    static_cast<double>(kCorners[k][2]));
      text += line;
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid tetra\n";
}

std::string binaryStl() {
  std::string bytes = "solid, says the header of this binary file";
  bytes.resize(80, ' ');
  put(bytes, std::uint32_t{4});
  for (const auto& face : kFaces) {
    bytes.append(12, '\0');
    for (std::uint32_t k : face)
      for (float c : kCorners[k]) put(bytes, c);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string plyText(bool ascii) {
  std::string out = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") +
                    " 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "property uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& c : kCorners) {
    char line[80];
    std::snprintf(line, sizeof line, "%g %g %g 255\n", static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2]));
    if (ascii) out += line;
    else put(out, c[0]), put(out, c[1]), put(out, c[2]), put(out, std::uint8_t{255});
  }
  for (const auto& f : kFaces) {
    if (ascii) out += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
    else put(out, std::uint8_t{3}), put(out, f[0]), put(out, f[1]), put(out, f[2]);
  }
  return out;
}

std::string vtpText() {
  return R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian">
  <PolyData>
    <Piece NumberOfPoints="4" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="4">
      <Points>
        <DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0  1 0 0  0 1 0  0 0 1</DataArray>
      </Points>
      <Polys>
        <DataArray type="Int32" Name="connectivity" format="ascii">0 2 1  0 1 3  1 2 3  0 3 2</DataArray>
        <DataArray type="Int32" Name="offsets" format="ascii">3 6 9 12</DataArray>
      </Polys>
    </Piece>
  </PolyData>
</VTKFile>
)";
}

std::string gltfBuffer() {
  std::string bytes;
  for (const auto& c : kCorners)
    for (float x : c) put(bytes, x);
  for (const auto& f : kFaces)
    for (std::uint32_t i : f) put(bytes, static_cast<std::uint16_t>(i));
  return bytes;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {  // gltfBuffer() has a multiple of three bytes
    const auto b = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])); };
    const unsigned bits = b(0) << 16 | b(1) << 8 | b(2);
    for (int shift = 18; shift >= 0; shift -= 6) out += kDigits[bits >> shift & 63u];
  }
  return out;
}

std::string gltfText(const std::string& uri) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "hull", "mesh": 0, "translation": [0, 0, 10]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"byteLength": 72)" +
         uri + "}]}";
}

std::string glbBytes() {
  std::string json = gltfText("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltfBuffer();
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(buffer.size()));
  return out + std::string("BIN\0", 4) + buffer;
}

void write(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string readAll(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<std::filesystem::path> writeSoundMeshes(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::pair<const char*, std::string> files[] = {{"a.obj", objText()},
                                                       {"a.stl", asciiStl()},
                                                       {"b.stl", binaryStl()},
                                                       {"a.ply", plyText(true)},
                                                       {"b.ply", plyText(false)},
                                                       {"a.vtp", vtpText()},
                                                       {"a.gltf", gltfText(", \"uri\": \"data:application/octet-stream;base64," + base64(gltfBuffer()) + "\"")},
                                                       {"a.glb", glbBytes()}};
  std::vector<std::filesystem::path> paths;
  for (const auto& [name, bytes] : files) {
    paths.push_back(folder / name);
    write(paths.back(), bytes);
  }
  return paths;
}

int fuzzMeshes(std::uint64_t seed, int iterations, const std::filesystem::path& corpus_folder) {
  const std::vector<std::filesystem::path> sound = writeSoundMeshes(corpus_folder / "sound");
  const std::string serialized = serializeMesh(makeSphere(1.0, 8));
  int failures = 0;
  for (int i = 0; i < iterations; ++i) {
    std::mt19937_64 random(seed + static_cast<std::uint64_t>(i));
    const std::filesystem::path& origin = sound[random() % sound.size()];
    std::string bytes = readAll(origin);
    for (std::uint64_t k = 0, count = 1 + random() % 3; k < count; ++k) damageBytes(bytes, random);
    const std::filesystem::path file = corpus_folder / ("case" + std::to_string(i) + origin.extension().string());
    write(file, bytes);
    std::string wrong;
    try {
      Mesh mesh = importMesh(file, 1.0, {});
      if (validateMesh(mesh, {}) != 0) wrong = "triangles without area came through";
    } catch (const UserError& error) {
      if (std::getenv("PITVIPER_FUZZ_VERBOSE") != nullptr) std::fprintf(stderr, "%s\n", error.what());
    } catch (const std::exception& error) {
      wrong = error.what();
    }
    std::string cached = serialized;
    damageBytes(cached, random);
    if (deserializeMesh(cached).has_value() && cached != serialized) wrong += " a damaged cache entry was taken";
    if (wrong.empty()) {
      std::filesystem::remove(file);
      continue;
    }
    ++failures;
    std::fprintf(stderr, "fuzz_mesh: seed %llu: %s: %s\n", static_cast<unsigned long long>(seed + static_cast<std::uint64_t>(i)), file.c_str(), wrong.c_str());
  }
  return failures;
}

}  // namespace pitviper
