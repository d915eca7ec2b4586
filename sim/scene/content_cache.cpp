#include "sim/scene/content_cache.hpp"

#include "sim/parameters/read_file.hpp"
#include "sim/scene/laws_digest.hpp"

namespace pitviper {
namespace {

constexpr const char* kPrefix = "table-";

std::filesystem::path fileOf(std::string_view what, const ContentKey& key) {
  return cacheFile(kPrefix + std::string(what) + "-" + std::string(lawsDigest()) + "-", key);
}

/// Behind the table's bytes, so that none is copied for it.
std::string sealOf(std::string_view bytes) {
  const ContentKey sum = contentKey(bytes);
  return std::string(reinterpret_cast<const char*>(sum.data()), sizeof sum);
}

}  // namespace

std::optional<std::string> readCachedTable(std::string_view what, const ContentKey& key) {
  try {
    const std::filesystem::path file = fileOf(what, key);
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored)) return std::nullopt;
    std::string bytes = readWholeFile(file, {.mostBytes = kLargestTable + sizeof(ContentKey)});
    const std::size_t size = bytes.size() < sizeof(ContentKey) ? 0 : bytes.size() - sizeof(ContentKey);
    if (bytes.size() < sizeof(ContentKey) || bytes.substr(size) != sealOf(std::string_view(bytes).substr(0, size))) {
      removeDamaged(file);
      return std::nullopt;
    }
    bytes.resize(size);
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), ignored);  // a cache may be one that is only read
    return bytes;
  } catch (const std::exception& e) {
    tellOfCacheTrouble(e.what());
    return std::nullopt;
  }
}

void writeCachedTable(std::string_view what, const ContentKey& key, std::string_view bytes) {
  if (bytes.size() <= kLargestTable) writeCacheFile(fileOf(what, key), std::string(bytes) + sealOf(bytes), kPrefix, kMostTableBytes);
}

}  // namespace pitviper
