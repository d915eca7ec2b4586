#pragma once
// A picture as packets of the stream protocol (GVSP): a leader, the pixels with their chunks, a trailer.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/stream/gige/gige_plan.hpp"
#include "sim/stream/gige/gige_types.hpp"

namespace pitviper {

class GvspBlock {
 public:
  static constexpr std::size_t kHeadMost = 20;
  static constexpr std::size_t kHeadersOfIp = 20 + 8;
  struct Packet {
    std::array<std::uint8_t, kHeadMost> head;
    std::size_t headBytes = 0;
    std::span<const std::uint8_t> data;  ///< of the block
  };

  /// Takes the place of what the block held before. `bits`: significant bits of the codes.
  void compose(const GigePicture& picture, const GigePlan& plan, int bits, std::uint64_t id);

  std::uint64_t id() const { return id_; }
  const GigePlan& plan() const { return plan_; }
  std::uint32_t packets() const { return packets_; }
  std::size_t bytes() const { return payload_.size(); }
  /// Any number below packets().
  Packet packet(std::uint32_t number) const;

  /// The answer to a request for what is gone.
  static Packet unavailable(std::uint64_t block, std::uint32_t number, bool hasWideIds);

  std::uint64_t resent = 0;  ///< packets sent again

 private:
  GigePlan plan_;
  std::uint64_t id_ = 0;
  std::uint32_t packets_ = 0;
  std::size_t dataBytes_ = 1;  ///< of a full packet
  std::array<std::uint8_t, 36> leader_{};
  std::array<std::uint8_t, 16> trailer_{};
  std::size_t trailerBytes_ = 0;
  std::vector<std::uint8_t> payload_;
};

}  // namespace pitviper
