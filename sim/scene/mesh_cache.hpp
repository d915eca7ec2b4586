#pragma once
// Meshes in our own binary form, and the folder where imported ones are kept: $XDG_CACHE_HOME/pitviper (or
// ~/.cache/pitviper). A cache file is a 32 byte header (magic and version, size and checksum of what follows), the names and keys of files that the
// imported one names, and the arrays of struct Mesh in this machine's byte order. Losing the folder costs time only.
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Two independent 64-bit hashes of the content: good against accidents, no protection against forgery.
using ContentKey = std::array<std::uint64_t, 2>;

ContentKey contentKey(std::string_view bytes, ContentKey seed = {});

/// A file beside an imported one that it names, and what was in it when it was read.
struct NamedFile {
  std::string name;  ///< as written there
  ContentKey key{};
};

std::string serializeMesh(const Mesh& mesh, const std::vector<NamedFile>& named = {});

/// nothing if the bytes are not a whole, undamaged mesh of this version. Sizes are checked before memory is taken;
/// indices and numbers are as trustworthy as the checksum. `named`: filled if given.
std::optional<Mesh> deserializeMesh(std::string_view bytes, std::vector<NamedFile>* named = nullptr);

/// Empty if neither XDG_CACHE_HOME (absolute) nor HOME is set.
std::filesystem::path meshCacheFolder();

/// nothing if it is not there, unreadable or damaged, or if `isUnchanged` says false of a file that the imported one names. Never throws.
std::optional<Mesh> readCachedMesh(const ContentKey& key, const std::function<bool(const NamedFile&)>& isUnchanged = {});

/// Keeps a mesh, atomically, then forgets those not used for longest while all together have more than kMostCachedBytes. A folder that cannot be written
/// is no error: the next run imports again. Never throws.
void writeCachedMesh(const ContentKey& key, const Mesh& mesh, const std::vector<NamedFile>& named = {});

/// Three meshes of 10 million triangles, the most that is imported, or a thousand ordinary ones.
inline constexpr std::uintmax_t kMostCachedBytes = std::uintmax_t{1} << 30;

/// Of the files in `folder` whose names begin with `prefix`, removes those not written or used for longest until the rest have at most `mostBytes`;
/// `keep` stays whatever its size. Also what killed processes left in it. Never throws.
void pruneCache(const std::filesystem::path& folder, std::string_view prefix, std::uintmax_t mostBytes, const std::filesystem::path& keep);

}  // namespace pitviper
