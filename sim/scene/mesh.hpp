#pragma once
// Triangle mesh in body coordinates: x forward, y left, z up, metres.
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pitviper {

/// A named range of triangles of a mesh that can carry its own material and temperature ("nozzle", "skin").
struct MeshPart {
  std::string name;
  std::uint32_t firstTriangle = 0;
  std::uint32_t triangleCount = 0;
};

/// positions, normals (unit, outward) and uv have the same length; triangles are counter-clockwise seen from outside.
/// parts cover all triangles in order, without gaps; a mesh without named parts has one, "all".
struct Mesh {
  std::vector<glm::vec3> positions;  ///< from offset_m
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uv;
  std::vector<glm::uvec3> triangles;
  std::vector<MeshPart> parts;
  bool closed = false;       ///< every edge shared by exactly two triangles: back faces can't be seen from outside
  bool heightField = false;  ///< one height over every place of x and y, seen from above: a line from above meets its upper side first
  glm::dvec3 offset_m{0.0};  ///< where positions count from, in body axes: the origin, unless the mesh lies so far from it that single precision would tell
  std::vector<std::string> notes;  ///< what its file had that a user should know of
};

}  // namespace pitviper
