#pragma once
// What something depends on, as bytes: two with the same bytes are the same. Everything goes in whole, nothing by samples.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace pitviper {

class Fingerprint {
 public:
  using Taker = std::function<void(std::string_view)>;
  Fingerprint() = default;
  /// Keeps nothing: gives its bytes away piece by piece, each but the last, which finish() gives, of a multiple of 8.
  explicit Fingerprint(Taker take) : take_(std::move(take)) {}
  void finish() { give(); }

  Fingerprint& add(double v) { return append(reinterpret_cast<const char*>(&v), sizeof v); }
  Fingerprint& add(const glm::dvec3& v) { return add(v.x).add(v.y).add(v.z); }
  Fingerprint& add(const glm::dquat& q) { return add(q.w).add(q.x).add(q.y).add(q.z); }
  Fingerprint& add(std::string_view s) {
    add(static_cast<double>(s.size()));
    return append(s.data(), s.size());
  }
  /// A list of plain values, with its length.
  template <class T>
  Fingerprint& all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    add(static_cast<double>(values.size()));
    return append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  /// Of one that keeps them.
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kPiece = 1 << 16;
  Fingerprint& append(const char* data, std::size_t count) {
    while (count > 0) {
      const std::size_t part = take_ ? std::min(count, kPiece - bytes_.size()) : count;
      bytes_.append(data, part);
      data += part, count -= part;
      if (take_ && bytes_.size() == kPiece) give();
    }
    return *this;
  }
  void give() {
    take_(bytes_);
    bytes_.clear();
  }
  std::string bytes_;
  Taker take_;  ///< none: they are kept
};

}  // namespace pitviper
