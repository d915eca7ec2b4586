#include "sim/scene/cache_folder.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

std::uint64_t mix(std::uint64_t h, std::uint64_t word, std::uint64_t multiplier) {
  h = (std::rotl(h, 27) ^ word) * multiplier;
  return h ^ (h >> 29);
}

/// Of so many bytes in all, in pieces of which each but the last has a multiple of 8.
class Hash {
 public:
  Hash(std::size_t bytes, ContentKey seed) : a_(mix(seed[0], bytes, kFirst)), b_(mix(seed[1], ~bytes, kSecond)) {}
  void add(std::string_view piece) {
    for (std::size_t i = 0; i < piece.size(); i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, piece.data() + i, std::min<std::size_t>(8, piece.size() - i));
      a_ = mix(a_, word, kFirst);
      b_ = mix(b_, word, kSecond);
    }
  }
  ContentKey key() const { return {mix(a_, b_, kFirst), mix(b_, a_, kSecond)}; }

 private:
  // The two multipliers are those of MurmurHash3 (Appleby, public domain); any odd constants with mixed bits would do.
  static constexpr std::uint64_t kFirst = 0xff51afd7ed558ccdu, kSecond = 0xc4ceb9fe1a85ec53u;
  std::uint64_t a_, b_;
};

std::atomic<TellOfCache> gTell{nullptr};
std::atomic<bool> gIsTold{false};

}  // namespace

ContentKey contentKey(std::string_view bytes, ContentKey seed) {
  Hash hash(bytes.size(), seed);
  hash.add(bytes);
  return hash.key();
}

ContentKey contentKeyOf(const std::function<void(Fingerprint&)>& tell) {
  const auto told = [&tell](Fingerprint::Taker take) {
    Fingerprint f(std::move(take));
    tell(f);
    f.finish();
  };
  std::size_t bytes = 0;
  told([&bytes](std::string_view piece) { bytes += piece.size(); });
  Hash hash(bytes, {});
  told([&hash](std::string_view piece) { hash.add(piece); });
  return hash.key();
}

std::filesystem::path cacheFolder() {
  // XDG Base Directory Specification: a path that is not absolute is to be ignored.
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') return std::filesystem::path(cache) / "pitviper";
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') return std::filesystem::path(home) / ".cache" / "pitviper";
  return {};
}

std::string digitsOf(const ContentKey& key) {
  return print("%016llx%016llx", static_cast<unsigned long long>(key[0]), static_cast<unsigned long long>(key[1]));
}

std::filesystem::path cacheFile(std::string_view prefix, const ContentKey& key) {
  const std::filesystem::path folder = cacheFolder();
  if (folder.empty()) return {};
  return folder / (std::string(prefix) + digitsOf(key));
}

void pruneCache(const std::filesystem::path& folder, std::string_view prefix, std::uintmax_t mostBytes, const std::filesystem::path& keep) {
  try {
    removeAbandonedTemporaries(folder);
    struct Kept {
      std::filesystem::file_time_type used;
      std::uintmax_t bytes;
      std::filesystem::path file;
    };
    std::vector<Kept> kept;
    std::uintmax_t total = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::error_code gone;  // another run may have been quicker
      if (!entry.path().filename().string().starts_with(prefix) || !entry.is_regular_file(gone)) continue;
      const auto used = entry.last_write_time(gone);
      const std::uintmax_t bytes = gone ? 0 : entry.file_size(gone);
      if (gone) continue;
      total += bytes;
      if (entry.path() != keep) kept.push_back({used, bytes, entry.path()});
    }
    std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    std::error_code ignored;
    for (const Kept& oldest : kept) {
      if (total <= mostBytes) return;
      std::filesystem::remove(oldest.file, ignored);
      total -= oldest.bytes;
    }
  } catch (const std::exception&) {
    // Too large a cache is no reason to end.
  }
}

void writeCacheFile(const std::filesystem::path& file, std::string_view bytes, std::string_view prefix, std::uintmax_t mostBytes) {
  if (file.empty()) return;
  try {
    std::filesystem::create_directories(file.parent_path());
    writeFileAtomically(file, bytes);
    pruneCache(file.parent_path(), prefix, mostBytes, file);
  } catch (const std::exception& e) {
    tellOfCacheTrouble(e.what());
  }
}

void tellOfCacheBy(TellOfCache tell) {
  gTell = tell;
  gIsTold = false;
}

void tellOfCacheTrouble(const std::string& reason) {
  if (const TellOfCache tell = gTell; tell && !gIsTold.exchange(true))
    tell(("note: the cache in " + cacheFolder().string() + " is of no use: " + reason +
          "; pictures are the same without it, but what takes long to make is made anew in each run; let XDG_CACHE_HOME name a folder that can be written and "
          "has room")
             .c_str());
}

void removeDamaged(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  tellOfCacheTrouble(file.filename().string() + " is damaged and was removed");
}

}  // namespace pitviper
