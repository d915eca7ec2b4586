#pragma once
// Which way the shells of a mesh from a file face.
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Turns triangles round until every closed shell has its outside out, a shell within another (the wall of a hollow, to any depth) its outside into the
/// hollow, and open sheets go round alike. A shell within another that belongs to other parts and is wound as that one stays a body of its own.
/// Normals are turned with their triangles; those that still point against them are made anew where `hasNormals`. Sets `closed`: every shell encloses
/// a volume. What was changed is told in `notes`. Needs valid indices, parts, normals and no triangle without area.
void orientShells(Mesh& mesh, bool hasNormals, double creaseAngle_rad);

}  // namespace pitviper
