#pragma once
// Meshes in our own binary form, in which imported ones are kept between runs. A cache file is a 32 byte header (magic and version, size and checksum of what
// follows), the names and keys of files that the imported one names, and the arrays of struct Mesh in this machine's byte order.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/cache_folder.hpp"
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// A file beside an imported one that it names, and what was in it when it was read.
struct NamedFile {
  std::string name;  ///< as written there
  ContentKey key{};
};

std::string serializeMesh(const Mesh& mesh, const std::vector<NamedFile>& named = {});

/// nothing if the bytes are not a whole, undamaged mesh of this version. Sizes are checked before memory is taken;
/// indices and numbers are as trustworthy as the checksum. `named`: filled if given.
std::optional<Mesh> deserializeMesh(std::string_view bytes, std::vector<NamedFile>* named = nullptr);

/// nothing if it is not there, unreadable or damaged (which is told), or if `isUnchanged` says false of a file that the imported one names. Never throws.
std::optional<Mesh> readCachedMesh(const ContentKey& key, const std::function<bool(const NamedFile&)>& isUnchanged = {});

/// Keeps a mesh, atomically, then forgets those not used for longest while all together have more than kMostCachedBytes. A folder that cannot be written
/// is told: the next run imports again. Never throws.
void writeCachedMesh(const ContentKey& key, const Mesh& mesh, const std::vector<NamedFile>& named = {});

/// Three meshes of 10 million triangles, the most that is imported, or a thousand ordinary ones.
inline constexpr std::uintmax_t kMostCachedBytes = std::uintmax_t{1} << 30;

}  // namespace pitviper
