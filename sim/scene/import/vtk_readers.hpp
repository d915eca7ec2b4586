#pragma once
// The only file pair that knows VTK. Throws ImportFailure for what VTK reports as an error.
#include <string>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Reads `file` (or the checked copy of it) with the reader for `extension` (lower case, with the dot).
/// The mesh's normals and uv are empty where the file has none; its parts are empty if it names none.
Mesh readWithVtk(const std::string& file, const std::string& extension, const CheckedFile& checked);

}  // namespace pitviper
