#pragma once
// What a file is, whatever its name: its SHA-256.
#include <filesystem>
#include <string>

namespace pitviper {

/// 64 hexadecimal digits (FIPS 180-4). The file is read piece by piece. Errors: OutputError where it cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace pitviper
