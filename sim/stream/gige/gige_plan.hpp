#pragma once
// What the controlling client has asked of the stream channel, and what may be asked: pixel formats and chunks.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace pitviper {

/// Codes of the Pixel Format Naming Convention. All 16-bit ones hold the codes as they are, least significant byte first.
enum class GigeFormat : std::uint32_t {
  Mono8 = 0x01080001,
  Mono10 = 0x01100003,
  Mono12 = 0x01100005,
  Mono12Packed = 0x010C0006,
  Mono14 = 0x01100025,
  Mono16 = 0x01100007,
};

struct GigeFormatName {
  GigeFormat format;
  const char* name;
};

/// Formats for codes of so many significant bits, at most 16: eight bits always, twelve packed where the codes have them, 16 always, and the one that names the
/// bits.
inline std::vector<GigeFormatName> gigeFormats(int bits) {
  std::vector<GigeFormatName> formats{{GigeFormat::Mono8, "Mono8"}};
  if (bits == 10) formats.push_back({GigeFormat::Mono10, "Mono10"});
  if (bits == 12) formats.push_back({GigeFormat::Mono12, "Mono12"});
  if (bits >= 12) formats.push_back({GigeFormat::Mono12Packed, "Mono12Packed"});
  if (bits == 14) formats.push_back({GigeFormat::Mono14, "Mono14"});
  formats.push_back({GigeFormat::Mono16, "Mono16"});
  return formats;
}

inline std::size_t gigeImageBytes(GigeFormat format, std::size_t pixels) {
  if (format == GigeFormat::Mono8) return pixels;
  if (format == GigeFormat::Mono12Packed) return (pixels * 12 + 7) / 8;
  return pixels * 2;
}

/// What may travel behind a picture; each a number of eight bytes.
struct GigeChunk {
  const char* name;  ///< entry of ChunkSelector; the feature is Chunk<name>
  bool isFloat;
  bool isStandard;  ///< a name of the convention
  const char* unit;
  const char* tip;
};
inline constexpr std::array<GigeChunk, 8> kGigeChunks{{
    {"FrameID", false, true, "", "Number of the picture in the simulation."},
    {"Timestamp", false, true, "ns", "Time of the picture, TAI."},
    {"ExposureTime", true, true, "us", "Exposure of the picture."},
    {"Gain", true, true, "dB", "Gain of the picture."},
    {"RadianceScale", true, false, "", "Radiance of one code: radiance is ChunkRadianceOffset + ChunkRadianceScale x code."},
    {"RadianceOffset", true, false, "", "Radiance of code zero."},
    {"Time", false, false, "ns", "Time of the picture in the simulation."},
    {"Flags", false, false, "", "Flags of the picture."},
}};
inline constexpr std::uint32_t kGigeImageChunkId = 0x1000;  ///< of the picture itself
inline constexpr std::uint32_t kGigeFirstChunkId = 0x1001;  ///< of the first of kGigeChunks, the others follow
inline constexpr std::size_t kGigeChunkBytes = 8 + 8;       ///< the number; its id and length behind it

enum class GigeTrigger : std::uint32_t { Software = 0, Line1 = 1, Action0 = 2 };

struct GigePlan {
  std::uint32_t address = 0;         ///< IPv4, 0: nowhere
  std::uint16_t port = 0;            ///< 0: nowhere
  std::uint32_t packetBytes = 1500;  ///< with headers of IP and UDP
  bool isFragmentable = true;
  std::uint32_t delay_ns = 0;  ///< between packets
  bool hasWideIds = false;     ///< 64-bit block ids
  GigeFormat format = GigeFormat::Mono16;
  bool hasChunks = false;
  std::uint32_t chunks = 0;    ///< a bit for each of kGigeChunks
  std::uint32_t pictures = 0;  ///< of an acquisition; 0: without end
  bool isTriggered = false;
  GigeTrigger source = GigeTrigger::Software;

  bool hasDestination() const { return address && port; }
};

/// Bytes of a picture with its chunks. Chunks are of whole words, that of the image too.
inline std::size_t gigePayloadBytes(const GigePlan& plan, std::size_t pixels) {
  const std::size_t image = gigeImageBytes(plan.format, pixels);
  if (!plan.hasChunks) return image;
  std::size_t bytes = (image + 3) / 4 * 4 + 8;
  for (std::size_t k = 0; k < kGigeChunks.size(); ++k)
    if (plan.chunks >> k & 1) bytes += kGigeChunkBytes;
  return bytes;
}

}  // namespace pitviper
