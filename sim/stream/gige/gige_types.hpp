#pragma once
// What a camera on the network is, what it sends and what it counted.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pitviper {

/// Pixels of a picture at most: its bytes with all headers are far from what 32 bits of a register hold.
inline constexpr long long kGigePixelsMost = 1LL << 26;

/// A camera as clients see it. Texts are cut to what the protocol has room for: 32 bytes, the serial number 16.
struct GigeSettings {
  std::string address = "127.0.0.1";  ///< IPv4 of this machine, one for each camera: all listen at port 3956
  std::string vendor = "pitviper";
  std::string model = "camera";
  std::string serial = "0";
  std::string version = "1";
  int width = 0;   ///< pixels; at most kGigePixelsMost in all
  int height = 0;  ///< pixels
  int bits = 16;   ///< significant bits of the codes, 8 to 16
  double rate_hz = 0;
  double exposure_us = 0;
  double exposureMin_us = 1;
  double exposureMax_us = 0;  ///< 0: a period of the rate, or a second where there is no rate
  double gain_dB = 0;
  double gainMin_dB = 0;
  double gainMax_dB = 48;
  /// Pictures leave no faster, like those of a camera on such a line: 0.5 ms for 640 x 512 codes on ten gigabits. A client on a busy machine, or one that keeps
  /// the kernel's small receive buffer, loses less of a slower one.
  int line_Mbps = 10000;
  /// Without it pictures go to the address of the controlling client and nowhere else.
  bool allowDestination = false;
};

/// What the controlling client asks for. Called from threads of the device, never after its destructor. Without
/// `exposure` or `gain` that feature is read-only; the others may be empty.
struct GigeCallbacks {
  std::function<void(double exposure_us)> exposure;
  std::function<void(double gain_dB)> gain;
  std::function<void()> softwareTrigger;  ///< also of an action command
  std::function<void(bool isOn)> acquisition;
  std::function<std::int64_t()> now_ns;  ///< TAI, for clients that latch the clock; the machine's own where empty
};

/// What the controlling client may set.
struct GigeAbilities {
  bool exposure = false;
  bool gain = false;
};

/// One picture; radiance = radianceOffset + radianceScale x code.
struct GigePicture {
  std::vector<std::uint16_t> codes;  ///< row by row from the top, width x height
  int width = 0;
  int height = 0;
  std::uint64_t sequence = 0;
  std::int64_t timestamp_ns = 0;  ///< TAI
  std::int64_t simulation_ns = 0;
  double exposure_us = 0;
  double gain_dB = 0;
  double radianceScale = 1;
  double radianceOffset = 0;
  std::uint64_t flags = 0;  ///< handed on as they are
};

struct GigeCounts {
  std::uint64_t pictures = 0;          ///< sent whole
  std::uint64_t packets = 0;           ///< of pictures, without those sent again
  std::uint64_t resent = 0;            ///< packets sent again
  std::uint64_t resendsNotServed = 0;  ///< requests for what is gone, never was, or was asked for too often
  std::uint64_t skipped = 0;           ///< pictures overtaken by newer ones while the sender was busy
  std::uint64_t cut = 0;               ///< pictures that ended early or never left: the socket refused, or the client stopped
  std::uint64_t withoutConsumer = 0;   ///< pictures while nobody streams
  std::uint64_t withoutTrigger = 0;    ///< pictures while a trigger is waited for
  std::uint64_t triggers = 0;          ///< accepted
  std::uint64_t triggersMissed = 0;    ///< while one was pending already
  std::uint64_t commands = 0;          ///< well-formed requests
  std::uint64_t malformed = 0;         ///< datagrams that are no request
  std::uint64_t refused = 0;           ///< requests of somebody who may not, or for a destination that may not be
  std::uint64_t throttled = 0;         ///< answers withheld from strangers who ask too much
  std::uint64_t heartbeatsLost = 0;    ///< controllers who fell silent
  std::uint64_t testPackets = 0;
};

}  // namespace pitviper
