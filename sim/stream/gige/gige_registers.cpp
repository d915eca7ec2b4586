#include "sim/stream/gige/gige_registers.hpp"

#include <algorithm>
#include <cstring>

#include "sim/parameters/print.hpp"
#include "sim/stream/gige/gige_plan.hpp"
#include "sim/stream/gige/wire.hpp"

namespace pitviper {
namespace {

using Field = GigeRegisters::Field;

/// All that a client may write.
constexpr Field kWritable[] = {
    {bootstrap::kUserName, 16},
    {bootstrap::kActionDeviceKey, 4},
    {bootstrap::kHeartbeat, 4},
    {bootstrap::kClockControl, 4},
    {bootstrap::kStreamConfiguration, 4},
    {bootstrap::kPrivilege, 4},
    {bootstrap::kStreamPort, 4},
    {bootstrap::kPacketSize, 4},
    {bootstrap::kPacketDelay, 4},
    {bootstrap::kDestination, 4},
    {bootstrap::kActionGroupKey, 4},
    {bootstrap::kActionGroupMask, 4},
    {feature::kFormat, 4},
    {feature::kMode, 4},
    {feature::kPictures, 4},
    {feature::kStart, 4},
    {feature::kStop, 4},
    {feature::kTriggerMode, 4},
    {feature::kTriggerSource, 4},
    {feature::kTriggerSoftware, 4},
    {feature::kChunkMode, 4},
    {feature::kChunkSelector, 4},
    {feature::kExposure, 8},
    {feature::kGain, 8},
};
constexpr std::uint32_t kChunkEnableBytes = 4 * static_cast<std::uint32_t>(kGigeChunks.size());

// Bits of the capabilities, the least significant first.
constexpr std::uint32_t kSeveralRegisters = 1u << 0, kWritesMemory = 1u << 1, kResends = 1u << 2, kKnowsActions = 1u << 6;
constexpr std::uint32_t kTellsPrimary = 1u << 27, kTellsLinkSpeed = 1u << 28, kHasSerial = 1u << 30, kHasUserName = 1u << 31;
constexpr std::uint32_t kTellsSourcePort = 0x80000000u, kKnowsShortIds = 0x40000000u;
constexpr std::uint32_t kFixedAddress = 1, kLinkLocal = 4;

}  // namespace

GigeRegisters::GigeRegisters(const GigeSettings& settings, const GigeNetwork& network, std::string xml) : memory_(feature::kEnd), xml_(std::move(xml)) {
  while (xml_.size() % 4) xml_ += '\n';  // reads are of whole words
  setWord(bootstrap::kVersion, 0x00020000);
  setWord(bootstrap::kDeviceMode, 0x80000001);  // most significant byte first; a transmitter; UTF-8
  // A locally administered address: many cameras may share one network card, and clients tell cameras apart by it.
  setWord(bootstrap::kMacHigh, 0x0250);
  setWord(bootstrap::kMacLow, network.address);
  setWord(bootstrap::kIpCapability, kFixedAddress | kLinkLocal);
  setWord(bootstrap::kIpConfiguration, kFixedAddress | kLinkLocal);
  for (const std::uint32_t at : {bootstrap::kAddress, bootstrap::kPersistentAddress}) setWord(at, network.address);
  for (const std::uint32_t at : {bootstrap::kMask, bootstrap::kPersistentMask}) setWord(at, network.mask);
  setText(bootstrap::kVendor, 32, settings.vendor);
  setText(bootstrap::kModel, 32, settings.model);
  setText(bootstrap::kDeviceVersion, 32, settings.version);
  setText(bootstrap::kInformation, 48, "simulated infrared camera");
  setText(bootstrap::kSerial, 16, settings.serial);
  setText(bootstrap::kXmlUrl, 512, print("Local:pitviper.xml;%x;%zx", feature::kXml, xml_.size()));
  for (const std::uint32_t at : {bootstrap::kInterfaces, bootstrap::kStreamChannels, bootstrap::kActions, bootstrap::kLinks}) setWord(at, 1);
  setWord(bootstrap::kLinkSpeed, static_cast<std::uint32_t>(settings.line_Mbps));
  setWord(bootstrap::kStreamCapability, kTellsSourcePort | kKnowsShortIds);
  setWord(bootstrap::kControlCapability,
          kSeveralRegisters | kWritesMemory | kResends | kKnowsActions | kTellsPrimary | kTellsLinkSpeed | kHasSerial | kHasUserName);
  setWord(bootstrap::kHeartbeat, kHeartbeatStart_ms);
  setWord(bootstrap::kTickLow, 1'000'000'000);
  setWord(bootstrap::kPacketSize, std::clamp(network.packetBytes, kPacketLeast, kPacketMost) / kPacketStep * kPacketStep);
  setWord(bootstrap::kSourcePort, network.sourcePort);
  setWord(feature::kWidth, static_cast<std::uint32_t>(settings.width));
  setWord(feature::kHeight, static_cast<std::uint32_t>(settings.height));
  setWord(feature::kFormat, static_cast<std::uint32_t>(settings.bits > 8 ? GigeFormat::Mono16 : GigeFormat::Mono8));
  setWord(feature::kPictures, 1);
  setNumber(feature::kExposure, settings.exposure_us);
  setNumber(feature::kGain, settings.gain_dB);
  setNumber(feature::kRate, settings.rate_hz);
}

GvcpStatus GigeRegisters::mayRead(std::uint32_t address, std::size_t bytes) const {
  if (address % 4 || bytes % 4) return GvcpStatus::BadAlignment;
  return isInside(address, bytes) ? GvcpStatus::Success : GvcpStatus::InvalidAddress;
}

GigeRegisters::Field GigeRegisters::writable(std::uint32_t address) const {
  for (const Field& f : kWritable)
    if (address >= f.address && address - f.address < f.bytes) return f;
  if (address >= feature::kChunkEnable && address - feature::kChunkEnable < kChunkEnableBytes) return {address / 4 * 4, 4};
  return {};
}

std::uint32_t GigeRegisters::word(std::uint32_t address) const { return wire32(find(address, 4)); }
void GigeRegisters::setWord(std::uint32_t address, std::uint32_t value) { putWire32(place(address, 4), value); }
double GigeRegisters::number(std::uint32_t address) const { return wireDouble(find(address, 8)); }
void GigeRegisters::setNumber(std::uint32_t address, double value) { putWireDouble(place(address, 8), value); }
void GigeRegisters::setBytes(std::uint32_t address, std::span<const std::uint8_t> value) { std::ranges::copy(value, place(address, value.size())); }

const std::uint8_t* GigeRegisters::find(std::uint32_t address, std::size_t bytes) const {
  if (address < memory_.size()) return bytes <= memory_.size() - address ? memory_.data() + address : nullptr;
  if (address < feature::kXml) return nullptr;
  const std::size_t at = address - feature::kXml;
  return at < xml_.size() && bytes <= xml_.size() - at ? reinterpret_cast<const std::uint8_t*>(xml_.data()) + at : nullptr;
}

void GigeRegisters::setText(std::uint32_t address, std::size_t room, const std::string& text) {
  std::memcpy(place(address, room), text.data(), std::min(text.size(), room - 1));  // a zero stays behind it
}

}  // namespace pitviper
