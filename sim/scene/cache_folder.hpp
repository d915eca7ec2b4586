#pragma once
// The folder of what is kept between runs, by content: $XDG_CACHE_HOME/pitviper (or ~/.cache/pitviper). Losing it costs time only: what cannot be read or
// written is made anew, which is said once.
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "sim/parameters/fingerprint.hpp"

namespace pitviper {

/// Two independent 64-bit hashes of the content: good against accidents, no protection against forgery.
using ContentKey = std::array<std::uint64_t, 2>;

ContentKey contentKey(std::string_view bytes, ContentKey seed = {});
/// Of the bytes that `tell` gives a fingerprint, none of which are kept: a scene's are as large as its meshes. Told twice, for their number stands before them.
ContentKey contentKeyOf(const std::function<void(Fingerprint&)>& tell);

/// Empty if neither XDG_CACHE_HOME (absolute) nor HOME is set.
std::filesystem::path cacheFolder();

/// A key as 32 hexadecimal digits.
std::string digitsOf(const ContentKey& key);
/// Of that content in the folder: `prefix` and the key, 32 hexadecimal digits. Empty where there is no folder.
std::filesystem::path cacheFile(std::string_view prefix, const ContentKey& key);

/// Of the files in `folder` whose names begin with `prefix`, removes those not written or used for longest until the rest have at most `mostBytes`;
/// `keep` stays whatever its size. Also what killed processes left in it. Never throws.
void pruneCache(const std::filesystem::path& folder, std::string_view prefix, std::uintmax_t mostBytes, const std::filesystem::path& keep);

/// Writes a file of the cache, whole or not at all, and prunes those of its prefix. Where it cannot be written that is told. Never throws.
void writeCacheFile(const std::filesystem::path& file, std::string_view bytes, std::string_view prefix, std::uintmax_t mostBytes);

/// Gets a line for the first trouble of a process with the folder; nobody without.
using TellOfCache = void (*)(const char* line);
void tellOfCacheBy(TellOfCache tell);
/// `reason`: what went wrong. The first of a process is told.
void tellOfCacheTrouble(const std::string& reason);
/// A file of the cache that is not what was written: removed, and told.
void removeDamaged(const std::filesystem::path& file);

}  // namespace pitviper
