#include "sim/scene/content_cache.hpp"

#include <atomic>
#include <cstdio>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr const char* kPrefix = "table-";

std::filesystem::path fileOf(std::string_view what, const ContentKey& key) {
  const std::filesystem::path folder = meshCacheFolder();
  if (folder.empty()) return {};
  char name[40];
  std::snprintf(name, sizeof name, "-%016llx%016llx", static_cast<unsigned long long>(key[0]), static_cast<unsigned long long>(key[1]));
  return folder / (kPrefix + std::string(what) + name);
}

/// Behind the table's bytes, so that none is copied for it.
std::string sealOf(std::string_view bytes) {
  const ContentKey sum = contentKey(bytes);
  return std::string(reinterpret_cast<const char*>(sum.data()), sizeof sum);
}

std::atomic<TellOfCache> gTell{nullptr};
std::atomic<bool> gIsTold{false};

}  // namespace

void tellOfCacheBy(TellOfCache tell) {
  gTell = tell;
  gIsTold = false;
}

void tellOfCacheTrouble(const std::string& reason) {
  if (const TellOfCache tell = gTell; tell && !gIsTold.exchange(true))
    tell(("note: the cache of tables in " + meshCacheFolder().string() + " is of no use: " + reason +
          "; pictures are the same without it, but what takes long to make is made anew in each run; let XDG_CACHE_HOME name a folder that can be written and "
          "has room")
             .c_str());
}

std::optional<std::string> readCachedTable(std::string_view what, const ContentKey& key) {
  try {
    const std::filesystem::path file = fileOf(what, key);
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored)) return std::nullopt;
    std::string bytes = readWholeFile(file, {.mostBytes = kLargestTable + sizeof(ContentKey)});
    const std::size_t size = bytes.size() < sizeof(ContentKey) ? 0 : bytes.size() - sizeof(ContentKey);
    if (bytes.size() < sizeof(ContentKey) || bytes.substr(size) != sealOf(std::string_view(bytes).substr(0, size))) {
      std::filesystem::remove(file, ignored);
      tellOfCacheTrouble(file.filename().string() + " is damaged and was removed");
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
  try {
    const std::filesystem::path file = fileOf(what, key);
    if (file.empty() || bytes.size() > kLargestTable) return;
    std::filesystem::create_directories(file.parent_path());
    writeFileAtomically(file, std::string(bytes) + sealOf(bytes));
    pruneCache(file.parent_path(), kPrefix, kMostTableBytes, file);
  } catch (const std::exception& e) {
    tellOfCacheTrouble(e.what());
  }
}

}  // namespace pitviper
