#pragma once
// CIGI 3.3, image generator to host: Start of Frame, which tells a host that a frame begins and which of its messages were taken.
#include <array>
#include <cstddef>
#include <cstdint>

#include "sim/stream/cigi/cigi_packets.hpp"

namespace pitviper {

struct CigiStartOfFrame {
  std::uint32_t igFrame = 0;    ///< rises by one with each frame
  std::uint32_t hostFrame = 0;  ///< of the newest IG Control that was taken
  int databaseNumber = 0;       ///< -128 to 127: what is loaded; its negative while it is being loaded; 0 where hosts choose none
  int statusCode = 0;           ///< 0: all is well; to 255: what the image generator's manual says
  CigiMode mode = CigiMode::Standby;
  bool timestampValid = false;
  std::uint32_t timestamp_10us = 0;  ///< when the frame began; wraps after 11.9 hours
};

/// Its bytes (packet 101), little-endian, version 3.3, earth reference model WGS 84. Numbers beyond a field are cut to its nearest.
std::array<std::byte, 24> cigiStartOfFrame(const CigiStartOfFrame& frame);

}  // namespace pitviper
