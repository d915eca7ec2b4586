#pragma once
// A whole file in memory.
#include <filesystem>
#include <string>

namespace pitviper {

/// Errors: UserError with the file name if it is missing, not a regular file, unreadable or larger than the memory.
std::string readWholeFile(const std::filesystem::path& path);

}  // namespace pitviper
