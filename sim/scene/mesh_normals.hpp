#pragma once
// Normals of vertices, from the file or made from the surface.
#include <cstdint>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Replaces the normals by angle-weighted means over the neighbours whose common edge bends by less than
/// creaseAngle_rad, and splits vertices where the surface bends more or where uv differ. Vertices are welded by exact
/// position first, so a triangle soup becomes smooth; unused vertices vanish. Needs valid indices. The order of
/// triangles is kept.
void computeNormals(Mesh& mesh, double creaseAngle_rad);

/// What becomes of the normal at a triangle's corner.
enum class CornerNormal : std::uint8_t { Kept, Turned, Made };

/// The same for some corners (3 t + k) only; vertices are split where their corners are not alike.
void changeNormals(Mesh& mesh, const std::vector<CornerNormal>& wish, double creaseAngle_rad);

}  // namespace pitviper
