#pragma once
// Meshes in our own binary form, and the folder where imported ones are kept: $XDG_CACHE_HOME/pitviper (or
// ~/.cache/pitviper). A cache file is a 32 byte header (magic and version, size and checksum of what follows) and the
// arrays of struct Mesh in this machine's byte order. Losing the folder costs time only.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Two independent 64-bit hashes of the content: good against accidents, no protection against forgery.
using ContentKey = std::array<std::uint64_t, 2>;

ContentKey contentKey(std::string_view bytes, ContentKey seed = {});

std::string serializeMesh(const Mesh& mesh);

/// nothing if the bytes are not a whole, undamaged mesh of this version. Sizes are checked before memory is taken;
/// indices and numbers are as trustworthy as the checksum.
std::optional<Mesh> deserializeMesh(std::string_view bytes);

/// Empty if neither XDG_CACHE_HOME (absolute) nor HOME is set.
std::filesystem::path meshCacheFolder();

/// nothing if it is not there, unreadable or damaged. Never throws.
std::optional<Mesh> readCachedMesh(const ContentKey& key);

/// Keeps a mesh, atomically. A folder that cannot be written is no error: the next run imports again. Never throws.
void writeCachedMesh(const ContentKey& key, const Mesh& mesh);

}  // namespace pitviper
