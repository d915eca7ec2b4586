#pragma once
// The memory of the camera as clients read it: where each register lies, who may write it, and what it holds at the start.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/stream/gige/gige_types.hpp"
#include "sim/stream/gige/gvcp.hpp"

namespace pitviper {

/// Places of the protocol's own registers (GigE Vision 2.0, bootstrap registers).
namespace bootstrap {
inline constexpr std::uint32_t kVersion = 0x0000, kDeviceMode = 0x0004, kMacHigh = 0x0008, kMacLow = 0x000C, kIpCapability = 0x0010, kIpConfiguration = 0x0014;
inline constexpr std::uint32_t kAddress = 0x0024, kMask = 0x0034, kGateway = 0x0044;
inline constexpr std::uint32_t kVendor = 0x0048, kModel = 0x0068, kDeviceVersion = 0x0088, kInformation = 0x00A8, kSerial = 0x00D8, kUserName = 0x00E8;
inline constexpr std::uint32_t kDiscoveryBytes = 0x00F8;  ///< an answer to a discovery holds the memory up to here
inline constexpr std::uint32_t kXmlUrl = 0x0200, kInterfaces = 0x0600, kPersistentAddress = 0x064C, kPersistentMask = 0x065C, kPersistentGateway = 0x066C;
inline constexpr std::uint32_t kLinkSpeed = 0x0670, kMessageChannels = 0x0900, kStreamChannels = 0x0904, kActions = 0x0908, kActionDeviceKey = 0x090C;
inline constexpr std::uint32_t kLinks = 0x0910, kStreamCapability = 0x092C, kControlCapability = 0x0934, kHeartbeat = 0x0938;
inline constexpr std::uint32_t kTickHigh = 0x093C, kTickLow = 0x0940, kClockControl = 0x0944, kClockHigh = 0x0948, kClockLow = 0x094C;
inline constexpr std::uint32_t kStreamConfiguration = 0x0960, kPrivilege = 0x0A00, kPrimaryPort = 0x0A04, kPrimaryAddress = 0x0A14;
inline constexpr std::uint32_t kStreamPort = 0x0D00, kPacketSize = 0x0D04, kPacketDelay = 0x0D08, kDestination = 0x0D18, kSourcePort = 0x0D1C;
inline constexpr std::uint32_t kActionGroupKey = 0x9800, kActionGroupMask = 0x9804;
inline constexpr std::uint32_t kEnd = 0xA000;
}  // namespace bootstrap

/// Places of the registers that the XML description names.
namespace feature {
inline constexpr std::uint32_t kWidth = 0xA000, kHeight = 0xA004, kFormat = 0xA008, kPayloadSize = 0xA00C;
inline constexpr std::uint32_t kMode = 0xA010, kPictures = 0xA014, kStart = 0xA018, kStop = 0xA01C;
inline constexpr std::uint32_t kTriggerMode = 0xA020, kTriggerSource = 0xA024, kTriggerSoftware = 0xA028;
inline constexpr std::uint32_t kChunkMode = 0xA030, kChunkSelector = 0xA034;
inline constexpr std::uint32_t kExposure = 0xA040, kGain = 0xA048, kRate = 0xA050;  ///< doubles
inline constexpr std::uint32_t kChunkEnable = 0xA080;                               ///< a word for each chunk
inline constexpr std::uint32_t kEnd = 0xA100;
inline constexpr std::uint32_t kXml = 0x10000;
}  // namespace feature

inline constexpr std::uint32_t kExclusive = 1, kControl = 2;                                 ///< of kPrivilege
inline constexpr std::uint32_t kFireTestPacket = 0x80000000u, kDoNotFragment = 0x40000000u;  ///< of kPacketSize
inline constexpr std::uint32_t kWideIdsOn = 0x40000000u;                                     ///< of kStreamConfiguration
inline constexpr std::uint32_t kLatchClock = 2;                                              ///< of kClockControl
/// Packet sizes with headers of IP and UDP. The least leaves room for a leader and a trailer; the most is what a jumbo frame of any hardware holds.
inline constexpr std::uint32_t kPacketLeast = 220, kPacketMost = 16000, kPacketStep = 4;
inline constexpr std::uint32_t kDelayMost_ns = 10'000'000;
inline constexpr std::uint32_t kHeartbeatLeast_ms = 500, kHeartbeatStart_ms = 3000,
                               kHeartbeatMost_ms = 60'000;  ///< a client that died keeps the camera so long

/// What the machine says of the network that an address belongs to.
struct GigeNetwork {
  std::uint32_t address = 0;
  std::uint32_t mask = 0;
  std::uint32_t packetBytes = 1500;  ///< to start with
  std::uint16_t sourcePort = 0;      ///< pictures come from there
};

class GigeRegisters {
 public:
  GigeRegisters(const GigeSettings& settings, const GigeNetwork& network, std::string xml);

  /// Whether these bytes may be read. Whole words only, as everywhere in the protocol.
  GvcpStatus mayRead(std::uint32_t address, std::size_t bytes) const;
  /// The register that holds this word for writing: its first address and its bytes; both zero where there is none.
  struct Field {
    std::uint32_t address = 0;
    std::uint32_t bytes = 0;
  };
  Field writable(std::uint32_t address) const;
  bool isInside(std::uint32_t address, std::size_t bytes) const { return find(address, bytes) != nullptr; }

  /// These do not ask who may; the place must be inside.
  std::span<const std::uint8_t> bytes(std::uint32_t address, std::size_t count) const { return {find(address, count), count}; }
  std::uint32_t word(std::uint32_t address) const;
  void setWord(std::uint32_t address, std::uint32_t value);
  double number(std::uint32_t address) const;
  void setNumber(std::uint32_t address, double value);
  void setBytes(std::uint32_t address, std::span<const std::uint8_t> value);

 private:
  const std::uint8_t* find(std::uint32_t address, std::size_t bytes) const;
  std::uint8_t* place(std::uint32_t address, std::size_t bytes) { return const_cast<std::uint8_t*>(find(address, bytes)); }
  void setText(std::uint32_t address, std::size_t room, const std::string& text);
  std::vector<std::uint8_t> memory_;  ///< up to feature::kEnd
  std::string xml_;                   ///< whole words
};

}  // namespace pitviper
