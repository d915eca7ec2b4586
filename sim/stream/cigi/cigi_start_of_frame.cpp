#include "sim/stream/cigi/cigi_start_of_frame.hpp"

#include <algorithm>

namespace pitviper {

std::array<std::byte, 24> cigiStartOfFrame(const CigiStartOfFrame& frame) {
  std::array<std::byte, 24> bytes{};
  const auto put = [&](std::size_t at, std::uint32_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xffu);
  };
  constexpr std::uint32_t minor = 3, wgs84 = 0;
  put(0, 101, 1);
  put(1, 24, 1);
  put(2, 3, 1);  // major version
  put(3, static_cast<std::uint8_t>(static_cast<std::int8_t>(std::clamp(frame.databaseNumber, -128, 127))), 1);
  put(4, static_cast<std::uint32_t>(std::clamp(frame.statusCode, 0, 255)), 1);
  put(5, minor << 4 | wgs84 << 3 | (frame.timestampValid ? 1u : 0u) << 2 | static_cast<std::uint32_t>(frame.mode), 1);
  put(6, 0x8000, 2);  // by which the host finds the byte order
  put(8, frame.igFrame, 4);
  put(12, frame.timestamp_10us, 4);
  put(16, frame.hostFrame, 4);
  return bytes;
}

}  // namespace pitviper
