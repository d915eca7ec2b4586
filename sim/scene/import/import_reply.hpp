#pragma once
// What the import module hands back. It never throws across its border: a mistake in the file is part of the reply.
#include <functional>
#include <string>
#include <string_view>

#include "sim/parameters/error.hpp"
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Most triangles of an imported file.
inline constexpr std::size_t kMostImportedTriangles = 10'000'000;

/// Positions in the file's units, triangles and parts as in struct Mesh; normals and uv are as long as positions, or
/// empty where the file has none. If `failed`, the mesh is empty and the rest says what UserError says.
struct ImportReply {
  Mesh mesh;
  bool failed = false;
  Location where;
  std::string wrong, expected, fix;
};

/// What the module is given: it opens no file itself.
struct ImportRequest {
  std::string file;        ///< for messages, and for its extension
  std::string_view bytes;  ///< the whole file
  /// Reads a file that this one names, relative to it. False where it cannot: `problem` then says why. Never throws.
  std::function<bool(const std::string& name, std::string& bytes, std::string& problem)> readNamed;
};

/// The module's one function, exported as kImportFunction.
using ImportFunction = void (*)(const ImportRequest& request, ImportReply* reply);
inline constexpr const char* kImportFunction = "pitviperImportMesh";
inline constexpr const char* kImportModule = "libpitviper_mesh_import.so";

}  // namespace pitviper
