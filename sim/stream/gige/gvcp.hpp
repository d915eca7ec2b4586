#pragma once
// Words of the control protocol (GVCP): commands, states of answers, sizes.
#include <cstddef>
#include <cstdint>

namespace pitviper {

inline constexpr std::uint16_t kGvcpPort = 3956;
inline constexpr std::uint8_t kGvcpKey = 0x42;
inline constexpr std::uint8_t kGvcpWantsAnswer = 0x01;
inline constexpr std::uint8_t kGvcpWideIds = 0x10;  ///< of a packet resend
inline constexpr std::uint8_t kGvcpHasTime = 0x80;  ///< of an action
inline constexpr std::size_t kGvcpHead = 8;
/// The longest packet: 576 bytes that every path of IPv4 carries, less the headers of IP and UDP.
inline constexpr std::size_t kGvcpLongest = 576 - 20 - 8;
inline constexpr std::size_t kGvcpLongestRead = kGvcpLongest - kGvcpHead - 4;

enum class GvcpCommand : std::uint16_t {
  Discovery = 0x0002,
  ForceIp = 0x0004,
  PacketResend = 0x0040,
  ReadRegisters = 0x0080,
  WriteRegisters = 0x0082,
  ReadMemory = 0x0084,
  WriteMemory = 0x0086,
  Action = 0x0100,
};

enum class GvcpStatus : std::uint16_t {
  Success = 0x0000,
  NotImplemented = 0x8001,
  InvalidParameter = 0x8002,
  InvalidAddress = 0x8003,
  WriteProtect = 0x8004,
  BadAlignment = 0x8005,
  AccessDenied = 0x8006,
  Busy = 0x8007,
  PacketUnavailable = 0x800C,
  InvalidHeader = 0x800E,
};

/// Whence a datagram came; both in the order of the host.
struct GigePeer {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  bool operator==(const GigePeer&) const = default;
};

}  // namespace pitviper
