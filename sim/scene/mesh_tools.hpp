#pragma once
// What can be measured of a mesh, and how meshes are joined and checked. Lengths in metres, body axes as in
// mesh.hpp.
#include <cstddef>
#include <glm/glm.hpp>
#include <string>

#include "sim/parameters/error.hpp"
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Most triangles that validateMesh() lets pass: 20 million, about 1 GiB of vertex and index data.
inline constexpr std::size_t kMostTriangles = 20'000'000;

struct BoundingSphere {
  glm::dvec3 center{0.0};
  double radius_m = 0.0;
};

/// Sum of the triangles' areas, m2. 0 for an empty mesh.
double surfaceArea(const Mesh& mesh);

/// Volume enclosed by a closed mesh, m3, positive when its triangles are counter-clockwise seen from outside.
/// Overlapping bodies count twice. Meaningless for an open mesh.
double signedVolume(const Mesh& mesh);

/// A sphere that holds every vertex, from the mesh's offset; at most a fifth larger than the smallest one.
BoundingSphere boundingSphere(const Mesh& mesh);

/// True when, with vertices at exactly equal positions taken as one, every edge is used as often in one direction as in
/// the other (twice in all, or four times where two bodies touch) and the enclosed volume is positive.
/// Then back faces cannot be seen from outside.
bool isClosed(const Mesh& mesh);

/// Appends all triangles of `part` as one part called `name`, moved by `placement` (affine; a mirroring one turns the
/// triangles round). If the last part of `into` has this name already, it grows. `into.closed` stays true only if both
/// are. Neither has an offset.
void appendPart(Mesh& into, const Mesh& part, const std::string& name, const glm::mat4& placement);

/// Checks an untrusted mesh and removes its triangles of zero area (and parts left empty); returns how many were
/// removed. Throws UserError at `where` for: no triangles, more than kMostTriangles, arrays of unequal length, indices
/// out of range, positions or normals or uv that are not finite, parts that don't cover the triangles in order.
std::size_t validateMesh(Mesh& mesh, const Location& where);

}  // namespace pitviper
