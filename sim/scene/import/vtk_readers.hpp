#pragma once
// The only file pair that knows VTK. Throws ImportFailure for what VTK reports as an error.
#include <string>
#include <string_view>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Reads `bytes`, checked, with the reader for `extension` (lower case, with the dot).
/// The mesh's normals and uv are empty where the file has none; its parts are empty if it names none.
/// `file` is for messages only.
Mesh readWithVtk(const std::string& file, const std::string& extension, std::string_view bytes, const CheckedFile& checked);

}  // namespace pitviper
