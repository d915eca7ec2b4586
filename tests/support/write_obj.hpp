#pragma once
// Meshes as files of a format that programs read: the shapes shipped beside scenarios/assets are what this makes of them.
#include <cstdio>
#include <string>

#include "sim/scene/mesh.hpp"

namespace pitviper::test {

/// Wavefront OBJ text of the mesh with normals, uv, and one group (g) per part; numbers have five digits.
inline std::string writeObj(const Mesh& mesh) {
  std::string text;
  char line[128];
  const auto put = [&](const char* format, auto... values) {
    text.append(line, static_cast<std::size_t>(std::snprintf(line, sizeof line, format, values...)));
  };
  const auto number = [](float v) { return static_cast<double>(v); };
  for (const glm::vec3& p : mesh.positions) put("v %.5g %.5g %.5g\n", number(p.x), number(p.y), number(p.z));
  for (const glm::vec2& t : mesh.uv) put("vt %.5g %.5g\n", number(t.x), number(t.y));
  for (const glm::vec3& n : mesh.normals) put("vn %.5g %.5g %.5g\n", number(n.x), number(n.y), number(n.z));
  for (const MeshPart& part : mesh.parts) {
    text += "g " + part.name + "\n";
    for (std::uint32_t i = 0; i < part.triangleCount; ++i) {
      const glm::uvec3 t = mesh.triangles[part.firstTriangle + i] + 1u;
      put("f %u/%u/%u %u/%u/%u %u/%u/%u\n", t.x, t.x, t.x, t.y, t.y, t.y, t.z, t.z, t.z);
    }
  }
  return text;
}

}  // namespace pitviper::test
