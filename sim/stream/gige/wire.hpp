#pragma once
// Numbers in packets and registers: GigE Vision writes all of them with the most significant byte first.
#include <bit>
#include <cstddef>
#include <cstdint>

namespace pitviper {

inline std::uint16_t wire16(const std::uint8_t* at) { return static_cast<std::uint16_t>(at[0] << 8 | at[1]); }
inline std::uint32_t wire32(const std::uint8_t* at) { return static_cast<std::uint32_t>(wire16(at)) << 16 | wire16(at + 2); }
inline std::uint64_t wire64(const std::uint8_t* at) { return static_cast<std::uint64_t>(wire32(at)) << 32 | wire32(at + 4); }
inline double wireDouble(const std::uint8_t* at) { return std::bit_cast<double>(wire64(at)); }

inline void putWire16(std::uint8_t* at, std::uint16_t value) {
  at[0] = static_cast<std::uint8_t>(value >> 8);
  at[1] = static_cast<std::uint8_t>(value);
}
inline void putWire32(std::uint8_t* at, std::uint32_t value) {
  putWire16(at, static_cast<std::uint16_t>(value >> 16));
  putWire16(at + 2, static_cast<std::uint16_t>(value));
}
inline void putWire64(std::uint8_t* at, std::uint64_t value) {
  putWire32(at, static_cast<std::uint32_t>(value >> 32));
  putWire32(at + 4, static_cast<std::uint32_t>(value));
}
inline void putWireDouble(std::uint8_t* at, double value) { putWire64(at, std::bit_cast<std::uint64_t>(value)); }

}  // namespace pitviper
