#pragma once
// Meshes from files: OBJ, STL, PLY, VTP, glTF. The readers are VTK's, in a module of their own that runs in a child
// process: whatever a damaged file does to them, this process gets a mesh or a UserError. Results are kept in the cache
// of mesh_cache.hpp under the file's content, so that a known file needs neither the module nor VTK.
#include <filesystem>

#include "sim/parameters/error.hpp"
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Reads .obj .stl .ply .vtp .gltf .glb (by extension, upper or lower case) and scales it by metresPerUnit.
///  Axes are taken as they are, except that glTF, whose front is +z and up +y by its standard, is turned into ours.
///  Coordinates are read in double precision; what lies farther from the file's origin than four times its own size gets an offset.
///  Parts: OBJ groups (g, else o), glTF nodes; equal names become one part. Others have one part, "all".
///  Normals and uv are kept where every face has them (OBJ, PLY, VTP, glTF); otherwise normals are computed with a
///  crease of 40 degrees and uv are 0. Polygons are cut into triangles; lines and points are ignored, triangles without
///  area dropped. Limits: 2 GiB and 10 million triangles a file. A glTF file's images are not read.
///  Shells are turned as orientShells() says (mesh_orientation.hpp): what it changes stands in the mesh's notes.
/// Throws UserError: at `askedAt` for a missing file, an unknown extension, a metresPerUnit that is not finite and
/// positive, or a missing module or VTK; in the file itself (line and column, or byte) for what is wrong there.
Mesh importMesh(const std::filesystem::path& file, double metresPerUnit, const Location& askedAt);

}  // namespace pitviper
