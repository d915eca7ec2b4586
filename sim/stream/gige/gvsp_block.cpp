#include "sim/stream/gige/gvsp_block.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "sim/stream/gige/gvcp.hpp"
#include "sim/stream/gige/wire.hpp"

namespace pitviper {
namespace {

enum : std::uint8_t { kLeader = 1, kTrailer = 2, kData = 3 };
constexpr std::uint8_t kWideIds = 0x80;
constexpr std::uint16_t kImage = 0x0001, kWithChunks = 0x4000;

std::size_t putHead(std::array<std::uint8_t, GvspBlock::kHeadMost>& head, GvcpStatus status, std::uint8_t kind, std::uint64_t block, std::uint32_t number,
                    bool hasWideIds) {
  head = {};
  putWire16(&head[0], static_cast<std::uint16_t>(status));
  if (!hasWideIds) {
    putWire16(&head[2], static_cast<std::uint16_t>(block));
    putWire32(&head[4], number & 0xFFFFFF);
    head[4] = kind;
    return 8;
  }
  head[4] = kWideIds | kind;
  putWire64(&head[8], block);
  putWire32(&head[16], number);
  return 20;
}

/// The most significant `wanted` of the `bits` of a code; one beyond its bits is the highest.
std::uint8_t* putImage(std::uint8_t* at, const std::vector<std::uint16_t>& codes, GigeFormat format, int bits) {
  const auto top = [&](std::size_t k, int wanted) {
    const unsigned most = (1u << wanted) - 1;
    return std::min(static_cast<unsigned>(codes[k]) >> (bits - wanted), most);
  };
  switch (format) {
    case GigeFormat::Mono8:
      for (std::size_t k = 0; k < codes.size(); ++k) *at++ = static_cast<std::uint8_t>(top(k, 8));
      return at;
    case GigeFormat::Mono12Packed:  // two pixels in three bytes: high bits of the first, low ones of both, high bits of the second
      for (std::size_t k = 0; k < codes.size(); k += 2) {
        const unsigned first = top(k, 12), second = k + 1 < codes.size() ? top(k + 1, 12) : 0;
        *at++ = static_cast<std::uint8_t>(first >> 4);
        *at++ = static_cast<std::uint8_t>((second & 15) << 4 | (first & 15));
        if (k + 1 < codes.size()) *at++ = static_cast<std::uint8_t>(second >> 4);
      }
      return at;
    default:
      if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(at, codes.data(), codes.size() * 2);
        return at + codes.size() * 2;
      }
      for (const std::uint16_t code : codes) *at++ = static_cast<std::uint8_t>(code), *at++ = static_cast<std::uint8_t>(code >> 8);
      return at;
  }
}

std::uint8_t* putChunkEnd(std::uint8_t* at, std::uint32_t id, std::size_t bytes) {
  putWire32(at, id);
  putWire32(at + 4, static_cast<std::uint32_t>(bytes));
  return at + 8;
}

std::uint64_t chunk(const GigePicture& p, std::size_t k) {  // in the order of kGigeChunks
  const std::array<std::uint64_t, kGigeChunks.size()> values{p.sequence,
                                                             static_cast<std::uint64_t>(p.timestamp_ns),
                                                             std::bit_cast<std::uint64_t>(p.exposure_us),
                                                             std::bit_cast<std::uint64_t>(p.gain_dB),
                                                             std::bit_cast<std::uint64_t>(p.radianceScale),
                                                             std::bit_cast<std::uint64_t>(p.radianceOffset),
                                                             static_cast<std::uint64_t>(p.simulation_ns),
                                                             p.flags};
  return values[k];
}

}  // namespace

void GvspBlock::compose(const GigePicture& picture, const GigePlan& plan, int bits, std::uint64_t id) {
  plan_ = plan;
  id_ = id;
  resent = 0;
  const std::size_t bytes = gigePayloadBytes(plan, picture.codes.size());
  payload_.resize(bytes);
  std::uint8_t* at = putImage(payload_.data(), picture.codes, plan.format, bits);
  if (plan.hasChunks) {
    while ((at - payload_.data()) % 4) *at++ = 0;
    at = putChunkEnd(at, kGigeImageChunkId, static_cast<std::size_t>(at - payload_.data()));
    for (std::uint32_t k = 0; k < kGigeChunks.size(); ++k) {
      if (!(plan.chunks >> k & 1)) continue;
      putWire64(at, chunk(picture, k));
      at = putChunkEnd(at + 8, kGigeFirstChunkId + k, 8);
    }
  }

  const std::uint16_t kind = plan.hasChunks ? kImage | kWithChunks : kImage;
  leader_ = {};
  putWire16(&leader_[2], kind);
  putWire64(&leader_[4], static_cast<std::uint64_t>(picture.timestamp_ns));
  putWire32(&leader_[12], static_cast<std::uint32_t>(plan.format));
  putWire32(&leader_[16], static_cast<std::uint32_t>(picture.width));
  putWire32(&leader_[20], static_cast<std::uint32_t>(picture.height));  // offsets and padding stay zero
  trailer_ = {};
  putWire16(&trailer_[2], kind);
  putWire32(&trailer_[4], static_cast<std::uint32_t>(picture.height));
  putWire32(&trailer_[8], static_cast<std::uint32_t>(bytes));  // all chunks; the layout's id behind it is always the same
  trailerBytes_ = plan.hasChunks ? 16 : 8;

  dataBytes_ = plan.packetBytes - kHeadersOfIp - (plan.hasWideIds ? 20 : 8);
  packets_ = static_cast<std::uint32_t>((bytes + dataBytes_ - 1) / dataBytes_) + 2;
}

GvspBlock::Packet GvspBlock::packet(std::uint32_t number) const {
  Packet packet;
  const std::uint8_t kind = number == 0 ? kLeader : number == packets_ - 1 ? kTrailer : kData;
  packet.headBytes = putHead(packet.head, GvcpStatus::Success, kind, id_, number, plan_.hasWideIds);
  if (kind == kLeader) packet.data = leader_;
  else if (kind == kTrailer) packet.data = std::span(trailer_).first(trailerBytes_);
  else {
    const std::size_t from = (number - 1) * dataBytes_;
    packet.data = std::span(payload_).subspan(from, std::min(dataBytes_, payload_.size() - from));
  }
  return packet;
}

GvspBlock::Packet GvspBlock::unavailable(std::uint64_t block, std::uint32_t number, bool hasWideIds) {
  Packet packet;
  packet.headBytes = putHead(packet.head, GvcpStatus::PacketUnavailable, kData, block, number, hasWideIds);
  return packet;
}

}  // namespace pitviper
