#pragma once
// The control channel (GVCP) without sockets: a datagram in, at most one out. Whatever arrives here may be hostile.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/stream/gige/gige_plan.hpp"
#include "sim/stream/gige/gige_registers.hpp"
#include "sim/stream/gige/gige_tally.hpp"

namespace pitviper {

/// Packets `first` to `last` of a block, to be sent once more.
struct GigeResend {
  std::uint64_t block = 0;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  bool hasWideIds = false;
};

/// What the control channel makes the rest of the camera do. None may block.
class GigeActions {
 public:
  virtual ~GigeActions() = default;
  virtual void configure(const GigePlan& plan) = 0;
  /// A stream opens or closes: block ids start anew, what was sent is forgotten.
  virtual void reopen() = 0;
  virtual void acquire(bool isOn) = 0;
  virtual bool isAcquiring() const = 0;
  virtual void trigger(GigeTrigger source) = 0;
  virtual void resend(const GigeResend& request) = 0;
  virtual void sendTestPacket(const GigePlan& plan) = 0;
  virtual void setExposure(double exposure_us) = 0;
  virtual void setGain(double gain_dB) = 0;
  virtual std::int64_t now_ns() = 0;
};

struct GigeReply {
  std::array<std::uint8_t, kGvcpLongest> bytes{};
  std::size_t size = 0;  ///< 0: no answer
  std::span<const std::uint8_t> span() const { return {bytes.data(), size}; }
};

/// Belongs to one thread.
class GigeControl {
 public:
  GigeControl(const GigeSettings& settings, const GigeAbilities& abilities, GigeRegisters registers, GigeActions& actions, GigeTally& tally);

  /// Time is any clock that never goes back. `isBroadcast`: it came by a broadcast, which only finds cameras and triggers them.
  void handle(std::span<const std::uint8_t> datagram, const GigePeer& from, bool isBroadcast, std::int64_t now_ms, GigeReply& reply);
  /// Drops a controller who fell silent.
  void tick(std::int64_t now_ms);
  bool isControlled() const { return controller_.has_value(); }

 private:
  struct Request;
  GvcpStatus answer(const Request& request, GigeReply& reply);
  GvcpStatus forceIp(const Request& request, GigeReply& reply);
  GvcpStatus readRegisters(const Request& request, GigeReply& reply);
  GvcpStatus readMemory(const Request& request, GigeReply& reply);
  GvcpStatus writeRegisters(const Request& request, GigeReply& reply);
  GvcpStatus writeMemory(const Request& request, GigeReply& reply);
  GvcpStatus resend(const Request& request);
  GvcpStatus action(const Request& request, GigeReply& reply);

  GvcpStatus mayRead(const GigePeer& who, std::uint32_t address) const;
  /// One register at most: as much of the bytes as it takes, in `written`.
  GvcpStatus write(const GigePeer& who, std::uint32_t address, std::span<const std::uint8_t> value, std::size_t& written);
  GvcpStatus writePrivilege(const GigePeer& who, std::uint32_t value);
  GvcpStatus writeWord(std::uint32_t address, std::uint32_t value);
  GvcpStatus writeFeature(std::uint32_t address, std::uint32_t value);
  GvcpStatus writeNumber(std::uint32_t address, double value);
  GvcpStatus writePacketSize(std::uint32_t value);
  GvcpStatus writeDestination(std::uint32_t address);
  void release();
  void stop();
  GigePlan plan() const;
  void configure();
  bool mayAnswer(std::int64_t now_ms);

  GigeSettings settings_;
  GigeAbilities abilities_;
  GigeRegisters registers_;
  GigeActions& actions_;
  GigeTally& tally_;

  struct Controller {
    GigePeer peer;
    std::int64_t heard_ms = 0;
  };
  std::optional<Controller> controller_;

  /// What a client changed last, and the answer: one that misses the answer asks again before it asks for anything else, and nothing may happen twice.
  struct Done {
    GigePeer from;
    std::int64_t at_ms = 0;
    std::vector<std::uint8_t> request;
    GigeReply reply;
  };
  std::array<Done, 4> done_;
  std::size_t nextDone_ = 0;

  double allowance_;  ///< answers to strangers
  std::int64_t allowedAt_ms_ = 0;
};

}  // namespace pitviper
