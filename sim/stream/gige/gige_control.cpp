#include "sim/stream/gige/gige_control.hpp"

#include <algorithm>

#include "sim/stream/gige/wire.hpp"

namespace pitviper {
namespace {

/// Time within which the same bytes are the same request. A client waits some 200 ms for an answer and asks three times or so.
constexpr std::int64_t kRepeats_ms = 1000;
/// Answers to those who do not control the camera: the requests may carry a forged sender, and answers are longer than they are. A client that reads
/// the description before it takes control needs a few hundred.
constexpr double kStrangersBurst = 1000, kStrangersRate_hz = 500;

bool isHost(const GigePeer& peer) { return peer.port && peer.address && peer.address < 0xE0000000u; }  // no multicast, no broadcast

void putHead(GigeReply& reply, GvcpStatus status, std::uint16_t command, std::uint16_t id, std::size_t bytes) {
  putWire16(&reply.bytes[0], static_cast<std::uint16_t>(status));
  putWire16(&reply.bytes[2], static_cast<std::uint16_t>(command + 1));  // answers have the number after their command's
  putWire16(&reply.bytes[4], static_cast<std::uint16_t>(bytes));
  putWire16(&reply.bytes[6], id);
  reply.size = kGvcpHead + bytes;
}

}  // namespace

struct GigeControl::Request {
  GvcpCommand command{};
  std::uint8_t flags = 0;
  GigePeer from;
  std::span<const std::uint8_t> data;
};

GigeControl::GigeControl(const GigeSettings& settings, const GigeAbilities& abilities, GigeRegisters registers, GigeActions& actions, GigeTally& tally)
    : settings_(settings), abilities_(abilities), registers_(std::move(registers)), actions_(actions), tally_(tally), allowance_(kStrangersBurst) {
  configure();
}

void GigeControl::handle(std::span<const std::uint8_t> datagram, const GigePeer& from, bool isBroadcast, std::int64_t now_ms, GigeReply& reply) {
  reply.size = 0;
  if (datagram.size() < kGvcpHead || datagram.size() > kGvcpLongest || datagram[0] != kGvcpKey || !isHost(from)) return tally_.add(&GigeCounts::malformed);
  const std::uint16_t command = wire16(&datagram[2]), id = wire16(&datagram[6]);
  const bool wantsAnswer = datagram[1] & kGvcpWantsAnswer;
  const bool isController = controller_ && controller_->peer == from;
  const bool isMalformed = wire16(&datagram[4]) != datagram.size() - kGvcpHead;
  tally_.add(isMalformed ? &GigeCounts::malformed : &GigeCounts::commands);
  const Request request{static_cast<GvcpCommand>(command), datagram[1], from, datagram.subspan(kGvcpHead)};
  if (isBroadcast) {
    const bool isForAll = request.command == GvcpCommand::Discovery || request.command == GvcpCommand::ForceIp || request.command == GvcpCommand::Action;
    if (isMalformed || !isForAll) return;
  }
  if (isController && !isMalformed) controller_->heard_ms = now_ms;
  const bool isLasting =
      request.command == GvcpCommand::WriteRegisters || request.command == GvcpCommand::WriteMemory || request.command == GvcpCommand::Action;
  if (isLasting)
    for (const Done& d : done_)
      if (d.from == from && now_ms - d.at_ms < kRepeats_ms && std::ranges::equal(d.request, datagram)) {
        reply = d.reply;
        return;
      }
  const GvcpStatus status = isMalformed ? GvcpStatus::InvalidHeader : answer(request, reply);
  if (status == GvcpStatus::AccessDenied) tally_.add(&GigeCounts::refused);
  // What a command may take effect as, it did; only the answer may be withheld. Packets sent again are their own answer.
  if (!wantsAnswer || request.command == GvcpCommand::PacketResend || (!reply.size && status == GvcpStatus::Success)) reply.size = 0;
  else putHead(reply, status, command, id, reply.size > kGvcpHead ? reply.size - kGvcpHead : 0);
  const bool isControllerNow = controller_ && controller_->peer == from;
  if (isControllerNow && !isController) controller_->heard_ms = now_ms;
  if (reply.size && !isController && !isControllerNow && !mayAnswer(now_ms)) reply.size = 0;
  if (isLasting && !isMalformed && status == GvcpStatus::Success) {
    auto place = std::ranges::find(done_, from, &Done::from);
    if (place == done_.end()) place = done_.begin() + static_cast<std::ptrdiff_t>(nextDone_++ % done_.size());
    *place = {from, now_ms, {datagram.begin(), datagram.end()}, reply};
  }
}

void GigeControl::tick(std::int64_t now_ms) {
  if (!controller_ || now_ms - controller_->heard_ms <= registers_.word(bootstrap::kHeartbeat)) return;
  tally_.add(&GigeCounts::heartbeatsLost);
  release();
}

bool GigeControl::mayAnswer(std::int64_t now_ms) {
  allowance_ = std::min(kStrangersBurst, allowance_ + kStrangersRate_hz * 1e-3 * static_cast<double>(now_ms - allowedAt_ms_));
  allowedAt_ms_ = now_ms;
  if (allowance_ < 1) {
    tally_.add(&GigeCounts::throttled);
    return false;
  }
  --allowance_;
  return true;
}

/// Leaves the answer's data in `reply`, with room for a head; an empty answer has the size of a head.
GvcpStatus GigeControl::answer(const Request& request, GigeReply& reply) {
  switch (request.command) {
    case GvcpCommand::Discovery: {
      if (!request.data.empty()) return GvcpStatus::InvalidHeader;
      std::ranges::copy(registers_.bytes(0, bootstrap::kDiscoveryBytes), reply.bytes.begin() + kGvcpHead);
      reply.size = kGvcpHead + bootstrap::kDiscoveryBytes;
      return GvcpStatus::Success;
    }
    case GvcpCommand::ForceIp:
      return forceIp(request, reply);
    case GvcpCommand::PacketResend:
      return resend(request);
    case GvcpCommand::ReadRegisters:
      return readRegisters(request, reply);
    case GvcpCommand::WriteRegisters:
      return writeRegisters(request, reply);
    case GvcpCommand::ReadMemory:
      return readMemory(request, reply);
    case GvcpCommand::WriteMemory:
      return writeMemory(request, reply);
    case GvcpCommand::Action:
      return action(request, reply);
  }
  return GvcpStatus::NotImplemented;
}

/// The address is the machine's: it can be confirmed, never changed.
GvcpStatus GigeControl::forceIp(const Request& request, GigeReply& reply) {
  if (request.data.size() != 56) return GvcpStatus::InvalidHeader;
  const bool isMine = wire16(&request.data[2]) == registers_.word(bootstrap::kMacHigh) && wire32(&request.data[4]) == registers_.word(bootstrap::kMacLow);
  if (!isMine) return GvcpStatus::Success;  // meant for another camera: silence
  if (wire32(&request.data[20]) != registers_.word(bootstrap::kAddress)) return GvcpStatus::NotImplemented;
  reply.size = kGvcpHead;
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::mayRead(const GigePeer& who, std::uint32_t address) const {
  const bool isExclusive = controller_ && controller_->peer != who && registers_.word(bootstrap::kPrivilege) & kExclusive;
  return isExclusive && address != bootstrap::kPrivilege ? GvcpStatus::AccessDenied : GvcpStatus::Success;
}

GvcpStatus GigeControl::readRegisters(const Request& request, GigeReply& reply) {
  if (request.data.empty() || request.data.size() % 4) return GvcpStatus::InvalidHeader;
  reply.size = kGvcpHead;
  for (std::size_t k = 0; k < request.data.size(); k += 4) {
    const std::uint32_t address = wire32(&request.data[k]);
    GvcpStatus status = mayRead(request.from, address);
    if (status == GvcpStatus::Success) status = registers_.mayRead(address, 4);
    if (status != GvcpStatus::Success) return status;  // those before it are answered
    putWire32(&reply.bytes[kGvcpHead + k], registers_.word(address));
    reply.size += 4;
  }
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::readMemory(const Request& request, GigeReply& reply) {
  if (request.data.size() != 8) return GvcpStatus::InvalidHeader;
  const std::uint32_t address = wire32(&request.data[0]);
  const std::size_t count = wire16(&request.data[6]);
  if (!count || count > kGvcpLongestRead) return GvcpStatus::InvalidParameter;
  GvcpStatus status = mayRead(request.from, address == bootstrap::kPrivilege && count > 4 ? 0 : address);
  if (status == GvcpStatus::Success) status = registers_.mayRead(address, count);
  if (status != GvcpStatus::Success) return status;
  putWire32(&reply.bytes[kGvcpHead], address);
  std::ranges::copy(registers_.bytes(address, count), reply.bytes.begin() + kGvcpHead + 4);
  reply.size = kGvcpHead + 4 + count;
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::writeRegisters(const Request& request, GigeReply& reply) {
  if (request.data.empty() || request.data.size() % 8) return GvcpStatus::InvalidHeader;
  GvcpStatus status = GvcpStatus::Success;
  std::size_t done = 0;
  for (; done < request.data.size() / 8; ++done) {
    std::size_t written = 0;
    status = write(request.from, wire32(&request.data[done * 8]), request.data.subspan(done * 8 + 4, 4), written);
    if (status != GvcpStatus::Success) break;
  }
  putWire16(&reply.bytes[kGvcpHead], 0);
  putWire16(&reply.bytes[kGvcpHead + 2], static_cast<std::uint16_t>(done));
  reply.size = kGvcpHead + 4;
  return status;
}

GvcpStatus GigeControl::writeMemory(const Request& request, GigeReply& reply) {
  if (request.data.size() <= 4) return GvcpStatus::InvalidHeader;
  const std::uint32_t address = wire32(&request.data[0]);
  const std::span<const std::uint8_t> value = request.data.subspan(4);
  if (address % 4 || value.size() % 4) return GvcpStatus::BadAlignment;
  GvcpStatus status = GvcpStatus::Success;
  std::size_t done = 0;
  while (done < value.size() && status == GvcpStatus::Success) {
    std::size_t written = 0;
    status = write(request.from, address + static_cast<std::uint32_t>(done), value.subspan(done), written);
    done += written;
  }
  putWire16(&reply.bytes[kGvcpHead], 0);
  putWire16(&reply.bytes[kGvcpHead + 2], static_cast<std::uint16_t>(done));
  reply.size = kGvcpHead + 4;
  return status;
}

GvcpStatus GigeControl::resend(const Request& request) {
  GigeResend wanted;
  wanted.hasWideIds = request.flags & kGvcpWideIds;
  if (request.data.size() != (wanted.hasWideIds ? 20u : 12u)) return GvcpStatus::InvalidHeader;
  // Clients ask from the socket that gets the pictures, which is another than the one that controls.
  const bool isClient = controller_ && (request.from == controller_->peer || (request.from.address == registers_.word(bootstrap::kDestination) &&
                                                                              request.from.port == registers_.word(bootstrap::kStreamPort)));
  if (!isClient) return GvcpStatus::AccessDenied;
  if (wire16(&request.data[0])) return GvcpStatus::InvalidParameter;  // there is one channel, 0
  const std::uint32_t ids = wanted.hasWideIds ? 0xFFFFFFFFu : 0x00FFFFFFu;
  wanted.block = wanted.hasWideIds ? wire64(&request.data[12]) : wire16(&request.data[2]);
  wanted.first = wire32(&request.data[4]) & ids;
  wanted.last = wire32(&request.data[8]) & ids;
  if (wanted.last < wanted.first) return GvcpStatus::InvalidParameter;
  actions_.resend(wanted);
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::action(const Request& request, GigeReply& reply) {
  const bool hasTime = request.flags & kGvcpHasTime;
  if (request.data.size() != (hasTime ? 20u : 12u)) return GvcpStatus::InvalidHeader;
  const std::uint32_t mask = wire32(&request.data[8]) & registers_.word(bootstrap::kActionGroupMask);
  const bool isMine = controller_ && mask && wire32(&request.data[0]) == registers_.word(bootstrap::kActionDeviceKey) &&
                      wire32(&request.data[4]) == registers_.word(bootstrap::kActionGroupKey);
  if (!isMine) return GvcpStatus::Success;  // silence
  if (hasTime) return GvcpStatus::NotImplemented;
  actions_.trigger(GigeTrigger::Action0);
  reply.size = kGvcpHead;
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::write(const GigePeer& who, std::uint32_t address, std::span<const std::uint8_t> value, std::size_t& written) {
  if (address % 4) return GvcpStatus::BadAlignment;
  const bool isMine = controller_ && controller_->peer == who;
  if (!isMine && (controller_ || address != bootstrap::kPrivilege)) return GvcpStatus::AccessDenied;
  const GigeRegisters::Field field = registers_.writable(address);
  if (!field.bytes) return registers_.isInside(address, 4) ? GvcpStatus::WriteProtect : GvcpStatus::InvalidAddress;
  GvcpStatus status = GvcpStatus::Success;
  std::size_t bytes = 4;
  if (field.bytes == 8) {  // half a double is no number
    if (address != field.address || value.size() < 8) return GvcpStatus::BadAlignment;
    bytes = 8;
    status = writeNumber(address, wireDouble(value.data()));
  } else if (field.bytes > 8) {
    bytes = std::min<std::size_t>(value.size(), field.address + field.bytes - address);
    registers_.setBytes(address, value.first(bytes));
  } else if (address == bootstrap::kPrivilege) {
    status = writePrivilege(who, wire32(value.data()));
  } else {
    status = writeWord(address, wire32(value.data()));
  }
  if (status == GvcpStatus::Success) written = bytes;
  return status;
}

GvcpStatus GigeControl::writePrivilege(const GigePeer& who, std::uint32_t value) {
  value &= kExclusive | kControl;
  if (!value) {
    if (controller_) release();
    return GvcpStatus::Success;
  }
  if (!controller_) controller_ = Controller{who, 0};  // handle() knows the time
  registers_.setWord(bootstrap::kPrivilege, value);
  registers_.setWord(bootstrap::kPrimaryPort, who.port);
  registers_.setWord(bootstrap::kPrimaryAddress, who.address);
  return GvcpStatus::Success;
}

/// Features stay as they were set, as clients expect of a camera; what belongs to the client goes with it.
void GigeControl::release() {
  stop();
  controller_.reset();
  for (const std::uint32_t at : {bootstrap::kPrivilege, bootstrap::kPrimaryPort, bootstrap::kPrimaryAddress, bootstrap::kStreamPort, bootstrap::kDestination,
                                 bootstrap::kStreamConfiguration})
    registers_.setWord(at, 0);
  registers_.setWord(bootstrap::kHeartbeat, kHeartbeatStart_ms);
  configure();
  actions_.reopen();
}

void GigeControl::stop() {
  if (actions_.isAcquiring()) actions_.acquire(false);
}

GvcpStatus GigeControl::writeWord(std::uint32_t address, std::uint32_t value) {
  switch (address) {
    case bootstrap::kHeartbeat:
      registers_.setWord(address, std::clamp(value, kHeartbeatLeast_ms, kHeartbeatMost_ms));
      return GvcpStatus::Success;
    case bootstrap::kClockControl:
      if (value & kLatchClock) {
        const auto now_ns = static_cast<std::uint64_t>(actions_.now_ns());
        registers_.setWord(bootstrap::kClockHigh, static_cast<std::uint32_t>(now_ns >> 32));
        registers_.setWord(bootstrap::kClockLow, static_cast<std::uint32_t>(now_ns));
      }
      return GvcpStatus::Success;  // a reset would leave TAI: it is not done
    case bootstrap::kActionDeviceKey:
    case bootstrap::kActionGroupKey:
    case bootstrap::kActionGroupMask:
      registers_.setWord(address, value);
      return GvcpStatus::Success;
    case bootstrap::kStreamConfiguration:
      if (actions_.isAcquiring()) return GvcpStatus::Busy;
      registers_.setWord(address, value & kWideIdsOn);
      break;
    case bootstrap::kStreamPort:
      registers_.setWord(address, value & 0xFFFF);  // above it: which network card, and there is one
      configure();
      actions_.reopen();
      return GvcpStatus::Success;
    case bootstrap::kPacketSize:
      return writePacketSize(value);
    case bootstrap::kPacketDelay:
      registers_.setWord(address, std::min(value, kDelayMost_ns));
      break;
    case bootstrap::kDestination:
      return writeDestination(value);
    default:
      return writeFeature(address, value);
  }
  configure();
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::writePacketSize(std::uint32_t value) {
  const std::uint32_t bytes = std::clamp(value & 0xFFFF, kPacketLeast, kPacketMost) / kPacketStep * kPacketStep;
  // A picture in flight keeps its size, and Aravis fires test packets between pictures only; yet a stream whose packets change their size cannot be put
  // together.
  if (actions_.isAcquiring() && bytes != (registers_.word(bootstrap::kPacketSize) & 0xFFFF)) return GvcpStatus::Busy;
  registers_.setWord(bootstrap::kPacketSize, bytes | (value & kDoNotFragment));
  configure();
  if (value & kFireTestPacket && plan().hasDestination()) actions_.sendTestPacket(plan());
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::writeDestination(std::uint32_t address) {
  const bool isOwn = controller_ && address == controller_->peer.address;
  const bool isSomewhere = address != 0xFFFFFFFFu;
  if (address && !isOwn && !(settings_.allowDestination && isSomewhere)) return GvcpStatus::AccessDenied;
  registers_.setWord(bootstrap::kDestination, address);
  configure();
  return GvcpStatus::Success;
}

GvcpStatus GigeControl::writeFeature(std::uint32_t address, std::uint32_t value) {
  const bool isBusy = actions_.isAcquiring();
  const auto set = [&](bool isValid, bool isFixedNow) {
    if (!isValid) return GvcpStatus::InvalidParameter;
    if (isFixedNow && isBusy && value != registers_.word(address)) return GvcpStatus::Busy;
    registers_.setWord(address, value);
    configure();
    return GvcpStatus::Success;
  };
  switch (address) {
    case feature::kFormat:
      return set(std::ranges::any_of(gigeFormats(settings_.bits), [&](const auto& f) { return static_cast<std::uint32_t>(f.format) == value; }), true);
    case feature::kMode:
      return set(value <= 2, true);
    case feature::kPictures:
      return set(value >= 1, true);
    case feature::kTriggerMode:
      return set(value <= 1, false);
    case feature::kTriggerSource:
      return set(value <= 2, false);
    case feature::kChunkMode:
      return set(value <= 1, true);
    case feature::kChunkSelector:
      return set(value < kGigeChunks.size(), false);
    case feature::kStart:
      if (!isBusy && value) actions_.acquire(true);
      return GvcpStatus::Success;
    case feature::kStop:
      if (value) stop();
      return GvcpStatus::Success;
    case feature::kTriggerSoftware:
      if (value) actions_.trigger(GigeTrigger::Software);
      return GvcpStatus::Success;
    default:
      return set(value <= 1, true);  // whether a chunk is sent
  }
}

GvcpStatus GigeControl::writeNumber(std::uint32_t address, double value) {
  const bool isExposure = address == feature::kExposure;
  if (!(isExposure ? abilities_.exposure : abilities_.gain)) return GvcpStatus::WriteProtect;
  const double least = isExposure ? settings_.exposureMin_us : settings_.gainMin_dB, most = isExposure ? settings_.exposureMax_us : settings_.gainMax_dB;
  if (!(value >= least && value <= most)) return GvcpStatus::InvalidParameter;
  registers_.setNumber(address, value);
  isExposure ? actions_.setExposure(value) : actions_.setGain(value);
  return GvcpStatus::Success;
}

GigePlan GigeControl::plan() const {
  GigePlan plan;
  plan.address = registers_.word(bootstrap::kDestination);
  plan.port = static_cast<std::uint16_t>(registers_.word(bootstrap::kStreamPort));
  plan.packetBytes = registers_.word(bootstrap::kPacketSize) & 0xFFFF;
  plan.isFragmentable = !(registers_.word(bootstrap::kPacketSize) & kDoNotFragment);
  plan.delay_ns = registers_.word(bootstrap::kPacketDelay);
  plan.hasWideIds = registers_.word(bootstrap::kStreamConfiguration) & kWideIdsOn;
  plan.format = static_cast<GigeFormat>(registers_.word(feature::kFormat));
  plan.hasChunks = registers_.word(feature::kChunkMode);
  for (std::uint32_t k = 0; k < kGigeChunks.size(); ++k)
    if (registers_.word(feature::kChunkEnable + 4 * k)) plan.chunks |= 1u << k;
  const std::uint32_t mode = registers_.word(feature::kMode);
  plan.pictures = mode == 0 ? 0 : mode == 1 ? 1 : registers_.word(feature::kPictures);
  plan.isTriggered = registers_.word(feature::kTriggerMode);
  plan.source = static_cast<GigeTrigger>(registers_.word(feature::kTriggerSource));
  return plan;
}

void GigeControl::configure() {
  registers_.setWord(feature::kPayloadSize, static_cast<std::uint32_t>(gigePayloadBytes(plan(), static_cast<std::size_t>(settings_.width) * settings_.height)));
  actions_.configure(plan());
}

}  // namespace pitviper
