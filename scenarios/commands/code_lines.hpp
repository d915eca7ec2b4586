#pragma once
// How much source there is.
#include <filesystem>

namespace pitviper {

/// Lines that are not blank, of all C++ and GLSL below a folder.
long codeLines(const std::filesystem::path& folder);

}  // namespace pitviper
