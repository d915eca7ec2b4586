#pragma once
// Vertices as keys: alike where every bit is.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace pitviper {

struct BitKeyHash {
  template <std::size_t N>
  std::size_t operator()(const std::array<std::uint32_t, N>& k) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;  // the golden ratio and two odd multipliers: any good mix will do
    for (std::uint32_t v : k) h = (std::rotl(h, 23) ^ v) * 0xff51afd7ed558ccdu;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

inline std::uint32_t bitsOf(float value) { return std::bit_cast<std::uint32_t>(value == 0.0f ? 0.0f : value); }  // -0 is 0

}  // namespace pitviper
