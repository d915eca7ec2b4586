#pragma once
// Tables that take long to make, kept between runs by the content that they are made from, beside imported meshes (cache_folder.hpp). A table read from it is
// the one that was written, byte by byte.
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sim/scene/cache_folder.hpp"

namespace pitviper {

/// All tables together; those not used for longest go first. A larger one than the other is not kept.
inline constexpr std::uintmax_t kMostTableBytes = std::uintmax_t{1} << 29, kLargestTable = std::uintmax_t{1} << 26;

/// `what`: the kind of table, of letters, digits and '-'. Nothing where it is not there, was made by other laws (laws_digest.hpp), or is damaged (which is
/// said). Never throws.
std::optional<std::string> readCachedTable(std::string_view what, const ContentKey& key);
/// Where it cannot be written that is said. Never throws.
void writeCachedTable(std::string_view what, const ContentKey& key, std::string_view bytes);

/// Lists of plain values as bytes, each behind its length.
class TableWriter {
 public:
  template <class T>
  void all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    const std::uint64_t count = values.size();
    bytes_.append(reinterpret_cast<const char*>(&count), sizeof count);
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// After the first list that does not fit everything fails.
class TableReader {
 public:
  explicit TableReader(std::string_view bytes) : left_(bytes) {}
  template <class T>
  std::vector<T> all() {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    std::uint64_t count = 0;
    ok_ = ok_ && left_.size() >= sizeof count;
    if (ok_) std::memcpy(&count, left_.data(), sizeof count), left_.remove_prefix(sizeof count);
    ok_ = ok_ && count <= left_.size() / sizeof(T);
    std::vector<T> values(ok_ ? count : 0);
    if (!values.empty())
      std::memcpy(static_cast<void*>(values.data()), left_.data(), values.size() * sizeof(T)), left_.remove_prefix(values.size() * sizeof(T));
    return values;
  }
  /// All was there, and nothing else.
  bool isWhole() const { return ok_ && left_.empty(); }

 private:
  std::string_view left_;
  bool ok_ = true;
};

}  // namespace pitviper
