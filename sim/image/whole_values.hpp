#pragma once
// Values as 16-bit whole numbers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pitviper {

/// Each rounded, within 0 to 65535; what is not finite is 0.
inline std::vector<std::uint16_t> wholeValues(const std::vector<float>& values) {
  std::vector<std::uint16_t> whole;
  whole.reserve(values.size());
  for (float v : values) whole.push_back(std::isfinite(v) ? static_cast<std::uint16_t>(std::lround(std::clamp(v, 0.0f, 65535.0f))) : std::uint16_t{0});
  return whole;
}

}  // namespace pitviper
