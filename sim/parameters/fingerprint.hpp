#pragma once
// What something depends on, as bytes: two with the same bytes are the same. Everything goes in whole, nothing by samples.
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pitviper {

class Fingerprint {
 public:
  Fingerprint& add(double v) {
    bytes_.append(reinterpret_cast<const char*>(&v), sizeof v);
    return *this;
  }
  Fingerprint& add(const glm::dvec3& v) { return add(v.x).add(v.y).add(v.z); }
  Fingerprint& add(const glm::dquat& q) { return add(q.w).add(q.x).add(q.y).add(q.z); }
  Fingerprint& add(std::string_view s) {
    add(static_cast<double>(s.size()));
    bytes_ += s;
    return *this;
  }
  /// A list of plain values, with its length.
  template <class T>
  Fingerprint& all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    add(static_cast<double>(values.size()));
    if (!values.empty()) bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace pitviper
