#include "sim/stream/gige/genicam_xml.hpp"

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

#include "sim/parameters/print.hpp"
#include "sim/stream/gige/gige_plan.hpp"
#include "sim/stream/gige/gige_registers.hpp"

namespace pitviper {
namespace {

enum class Access { ReadOnly, WriteOnly, ReadWrite };
using Entries = std::vector<std::pair<std::string, std::uint32_t>>;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') result += "&amp;";
    else if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else if (c == '"') result += "&quot;";
    else if (static_cast<unsigned char>(c) < 32) result += ' ';
    else result += c;
  }
  return result;
}

std::string number(double value) { return print("%.17g", value); }
std::string hex(std::uint32_t value) { return print("0x%X", value); }
std::string tag(const std::string& name, const std::string& content) { return content.empty() ? "" : "<" + name + ">" + content + "</" + name + ">\n"; }
const char* word(Access access) { return access == Access::ReadOnly ? "RO" : access == Access::WriteOnly ? "WO" : "RW"; }

/// Lists features by category while it writes their nodes.
class Description {
 public:
  void category(const std::string& name) { categories_.emplace_back(name, ""); }

  /// What a feature says of itself before its value.
  struct About {
    std::string tip;
    bool isFixedWhileStreaming = false;
    std::string visibility = "Beginner";
    bool isReadOnly = false;  ///< where no register says so
    bool isStandard = true;   ///< a name of the convention
  };

  void integer(const std::string& name, std::uint32_t address, Access access, const About& about, const std::string& limits = "",
               const std::string& unit = "") {
    open("Integer", name, about);
    body_ += tag("pValue", name + "Reg") + limits + tag("Unit", unit);
    close("Integer");
    intRegister(name + "Reg", tag("Address", hex(address)), 4, access, "Device");
  }
  /// A number that never changes.
  void constant(const std::string& name, long long value, About about) {
    about.isReadOnly = true;
    open("Integer", name, about);
    body_ += tag("Value", std::to_string(value));
    close("Integer");
  }
  /// Some bits of a word, counted from the most significant one.
  void bits(const std::string& name, std::uint32_t address, int first, int last, Access access, const About& about, const std::string& limits = "") {
    open("Integer", name, about);
    body_ += tag("pValue", name + "Reg") + limits;
    close("Integer");
    maskedRegister(name + "Reg", address, tag("LSB", std::to_string(last)) + tag("MSB", std::to_string(first)), access);
  }
  void bit(const std::string& name, std::uint32_t address, int place, const About& about) {
    open("Boolean", name, about);
    body_ += tag("pValue", name + "Reg") + tag("OnValue", "1") + tag("OffValue", "0");
    close("Boolean");
    maskedRegister(name + "Reg", address, tag("Bit", std::to_string(place)), Access::ReadWrite);
  }
  void command(const std::string& name, std::uint32_t address, std::uint32_t value, const About& about) {
    open("Command", name, about);
    body_ += tag("pValue", name + "Reg") + tag("CommandValue", std::to_string(value));
    close("Command");
    intRegister(name + "Reg", tag("Address", hex(address)), 4, Access::WriteOnly, "Device");
  }
  void bitCommand(const std::string& name, std::uint32_t address, int place, const About& about) {
    open("Command", name, about);
    body_ += tag("pValue", name + "Reg") + tag("CommandValue", "1");
    close("Command");
    maskedRegister(name + "Reg", address, tag("Bit", std::to_string(place)), Access::ReadWrite);
  }
  void real(const std::string& name, std::uint32_t address, Access access, const About& about, const std::string& limits, const std::string& unit) {
    open("Float", name, about);
    body_ += tag("pValue", name + "Reg") + limits + tag("Unit", unit);
    close("Float");
    floatRegister(name + "Reg", tag("Address", hex(address)), access, "Device");
  }
  void text(const std::string& name, std::uint32_t address, int bytes, Access access, const About& about) {
    open("StringReg", name, about);
    body_ += tag("Address", hex(address)) + tag("Length", std::to_string(bytes)) + tag("AccessMode", word(access)) + tag("pPort", "Device");
    if (access != Access::ReadOnly) body_ += tag("Cachable", "NoCache");
    close("StringReg");
  }
  void choice(const std::string& name, std::uint32_t address, Access access, const Entries& entries, const About& about,
              const std::vector<std::string>& selected = {}) {
    open("Enumeration", name, about);
    entriesOf(entries);
    body_ += tag("pValue", name + "Reg");
    for (const std::string& s : selected) body_ += tag("pSelected", s);
    close("Enumeration");
    intRegister(name + "Reg", tag("Address", hex(address)), 4, access, "Device");
  }
  /// Of one entry, or a selector that the client keeps to itself.
  void fixedChoice(const std::string& name, const Entries& entries, const About& about, const std::vector<std::string>& selected = {}) {
    open("Enumeration", name, about);
    entriesOf(entries);
    body_ += tag("Value", std::to_string(entries.front().second));
    for (const std::string& s : selected) body_ += tag("pSelected", s);
    close("Enumeration");
  }
  void chunkEnable(const std::string& tip) {
    open("Boolean", "ChunkEnable", {tip, true});
    body_ += tag("pValue", "ChunkEnableReg") + tag("OnValue", "1") + tag("OffValue", "0");
    close("Boolean");
    intRegister("ChunkEnableReg", tag("Address", hex(feature::kChunkEnable)) + "<pIndex Offset=\"4\">ChunkSelector</pIndex>\n", 4, Access::ReadWrite, "Device");
  }
  void chunk(const GigeChunk& c, std::uint32_t id) {
    const std::string name = std::string("Chunk") + c.name, port = name + "Port";
    open(c.isFloat ? "Float" : "Integer", name, {c.tip, false, "Beginner", false, c.isStandard});
    body_ += tag("pValue", name + "Reg") + tag("Unit", c.unit);
    close(c.isFloat ? "Float" : "Integer");
    if (c.isFloat) floatRegister(name + "Reg", tag("Address", "0x0"), Access::ReadOnly, port);
    else intRegister(name + "Reg", tag("Address", "0x0"), 8, Access::ReadOnly, port);
    openNode("Port", port);
    body_ += tag("ChunkID", print("%x", id));  // without 0x
    close("Port");
  }
  /// Two words of one number.
  void wide(const std::string& name, std::uint32_t address, const About& about, const std::string& unit) {
    open("Integer", name, about);
    body_ += tag("pValue", name + "Reg") + tag("Unit", unit);
    close("Integer");
    intRegister(name + "Reg", tag("Address", hex(address)), 8, Access::ReadOnly, "Device");
  }
  /// Writable by the client, kept by it alone.
  void locked() {
    open("Integer", "TLParamsLocked", {"Set by the client while it streams.", false, "Invisible"});
    body_ += tag("Value", "0") + tag("Min", "0") + tag("Max", "1");
    close("Integer");
  }

  std::string nodes() const {
    std::string result = "<Category Name=\"Root\" NameSpace=\"Standard\">\n";
    for (const auto& [name, features] : categories_) result += tag("pFeature", name);
    result += "</Category>\n";
    for (const auto& [name, features] : categories_) result += "<Category Name=\"" + name + "\" NameSpace=\"Standard\">\n" + features + "</Category>\n";
    return result + body_ + "<Port Name=\"Device\" NameSpace=\"Standard\">\n</Port>\n";
  }

 private:
  void openNode(const std::string& kind, const std::string& name) { body_ += "<" + kind + " Name=\"" + name + "\">\n"; }
  void open(const std::string& kind, const std::string& name, const About& about) {
    categories_.back().second += tag("pFeature", name);
    body_ += "<" + kind + " Name=\"" + name + "\" NameSpace=\"" + (about.isStandard ? "Standard" : "Custom") + "\">\n" + tag("ToolTip", about.tip) +
             tag("Visibility", about.visibility);
    if (about.isFixedWhileStreaming) body_ += tag("pIsLocked", "TLParamsLocked");
    if (about.isReadOnly) body_ += tag("ImposedAccessMode", "RO");
  }
  void close(const std::string& kind) { body_ += "</" + kind + ">\n"; }
  void entriesOf(const Entries& entries) {
    for (const auto& [entry, value] : entries)
      body_ +=
          "<EnumEntry Name=\"" + entry + "\" NameSpace=\"Standard\">\n" + tag("DisplayName", entry) + tag("Value", std::to_string(value)) + "</EnumEntry>\n";
  }
  void intRegister(const std::string& name, const std::string& place, int bytes, Access access, const std::string& port) {
    openNode("IntReg", name);
    body_ += place + tag("Length", std::to_string(bytes)) + tag("AccessMode", word(access)) + tag("pPort", port) + tag("Cachable", "NoCache") +
             tag("Sign", bytes == 8 ? "Signed" : "Unsigned") + tag("Endianess", "BigEndian");
    close("IntReg");
  }
  void maskedRegister(const std::string& name, std::uint32_t address, const std::string& bits, Access access) {
    openNode("MaskedIntReg", name);
    body_ += tag("Address", hex(address)) + tag("Length", "4") + tag("AccessMode", word(access)) + tag("pPort", "Device") + tag("Cachable", "NoCache") + bits +
             tag("Sign", "Unsigned") + tag("Endianess", "BigEndian");
    close("MaskedIntReg");
  }
  void floatRegister(const std::string& name, const std::string& place, Access access, const std::string& port) {
    openNode("FloatReg", name);
    body_ += place + tag("Length", "8") + tag("AccessMode", word(access)) + tag("pPort", port) + tag("Cachable", "NoCache") + tag("Endianess", "BigEndian");
    close("FloatReg");
  }
  std::vector<std::pair<std::string, std::string>> categories_;
  std::string body_;
};

template <class Number>
std::string range(Number least, Number most) {
  if constexpr (std::is_floating_point_v<Number>) return tag("Min", number(least)) + tag("Max", number(most));
  else return tag("Min", std::to_string(least)) + tag("Max", std::to_string(most));
}

void device(Description& d) {
  d.category("DeviceControl");
  d.fixedChoice("DeviceType", {{"Transmitter", 0}}, {"What the device does.", false, "Expert", true});
  d.fixedChoice("DeviceScanType", {{"Areascan", 0}}, {"Pictures are of an area.", false, "Expert", true});
  d.text("DeviceVendorName", bootstrap::kVendor, 32, Access::ReadOnly, {"Name of the vendor."});
  d.text("DeviceModelName", bootstrap::kModel, 32, Access::ReadOnly, {"Name of the camera."});
  d.text("DeviceManufacturerInfo", bootstrap::kInformation, 48, Access::ReadOnly, {"What the vendor says of it."});
  d.text("DeviceVersion", bootstrap::kDeviceVersion, 32, Access::ReadOnly, {"Version of the camera."});
  d.text("DeviceSerialNumber", bootstrap::kSerial, 16, Access::ReadOnly, {"Serial number."});
  d.text("DeviceID", bootstrap::kSerial, 16, Access::ReadOnly, {"Serial number, under its old name."});
  d.text("DeviceUserID", bootstrap::kUserName, 16, Access::ReadWrite, {"A name of the user's choice, kept until the camera ends."});
  d.command("TimestampLatch", bootstrap::kClockControl, kLatchClock, {"Keeps the time of now in TimestampLatchValue.", false, "Expert"});
  d.wide("TimestampLatchValue", bootstrap::kClockHigh, {"Time that TimestampLatch kept, TAI.", false, "Expert"}, "ns");
}

void image(Description& d, const GigeSettings& s) {
  d.category("ImageFormatControl");
  d.constant("SensorWidth", s.width, {"Columns of the detector."});
  d.constant("SensorHeight", s.height, {"Rows of the detector."});
  d.constant("WidthMax", s.width, {"Columns of the largest picture."});
  d.constant("HeightMax", s.height, {"Rows of the largest picture."});
  d.integer("Width", feature::kWidth, Access::ReadOnly, {"Columns of the picture."}, range(s.width, s.width) + tag("Inc", "1"));
  d.integer("Height", feature::kHeight, Access::ReadOnly, {"Rows of the picture."}, range(s.height, s.height) + tag("Inc", "1"));
  d.constant("OffsetX", 0, {"First column of the picture."});
  d.constant("OffsetY", 0, {"First row of the picture."});
  Entries formats;
  for (const auto& [format, name] : gigeFormats(s.bits)) formats.emplace_back(name, static_cast<std::uint32_t>(format));
  d.choice("PixelFormat", feature::kFormat, Access::ReadWrite, formats,
           {"How codes are sent. Formats of eight and twelve bits hold the most significant bits, formats of 16 the codes as they are.", true});
  d.constant("PixelDynamicRangeMin", 0, {"The lowest code."});
  d.constant("PixelDynamicRangeMax", (1LL << s.bits) - 1, {"The highest code."});
}

void acquisition(Description& d, const GigeSettings& s, const GigeAbilities& abilities) {
  d.category("AcquisitionControl");
  d.choice("AcquisitionMode", feature::kMode, Access::ReadWrite, {{"Continuous", 0}, {"SingleFrame", 1}, {"MultiFrame", 2}},
           {"When an acquisition ends by itself.", true});
  d.command("AcquisitionStart", feature::kStart, 1, {"Starts to send pictures."});
  d.command("AcquisitionStop", feature::kStop, 1, {"Ends it."});
  d.integer("AcquisitionFrameCount", feature::kPictures, Access::ReadWrite, {"Pictures of an acquisition of MultiFrame.", true}, range(1LL, 0xFFFFFFFFLL));
  d.real("AcquisitionFrameRate", feature::kRate, Access::ReadOnly, {"Pictures of the simulation a second."}, range(s.rate_hz, s.rate_hz), "Hz");
  d.real("ExposureTime", feature::kExposure, abilities.exposure ? Access::ReadWrite : Access::ReadOnly, {"Time of exposure."},
         range(s.exposureMin_us, s.exposureMax_us), "us");
  d.fixedChoice("ExposureMode", {{"Timed", 1}}, {"ExposureTime tells the time of exposure."});
  d.fixedChoice("TriggerSelector", {{"FrameStart", 0}}, {"What triggers start."}, {"TriggerMode", "TriggerSource", "TriggerSoftware", "TriggerActivation"});
  d.choice("TriggerMode", feature::kTriggerMode, Access::ReadWrite, {{"Off", 0}, {"On", 1}}, {"With it a picture is sent for a trigger only."});
  d.choice("TriggerSource", feature::kTriggerSource, Access::ReadWrite, {{"Software", 0}, {"Line1", 1}, {"Action0", 2}}, {"Whence triggers come."});
  d.fixedChoice("TriggerActivation", {{"RisingEdge", 0}}, {"Edge of the line that triggers."});
  d.command("TriggerSoftware", feature::kTriggerSoftware, 1, {"Triggers once."});
}

void analog(Description& d, const GigeSettings& s, const GigeAbilities& abilities) {
  d.category("AnalogControl");
  d.real("Gain", feature::kGain, abilities.gain ? Access::ReadWrite : Access::ReadOnly, {"Gain of the electronics."}, range(s.gainMin_dB, s.gainMax_dB), "dB");
}

void chunks(Description& d) {
  d.category("ChunkDataControl");
  Entries entries;
  for (std::uint32_t k = 0; k < kGigeChunks.size(); ++k) entries.emplace_back(kGigeChunks[k].name, k);
  d.bit("ChunkModeActive", feature::kChunkMode, 31, {"Whether chunks travel with each picture.", true});
  d.choice("ChunkSelector", feature::kChunkSelector, Access::ReadWrite, entries, {"Chunk that ChunkEnable is about."}, {"ChunkEnable"});
  d.chunkEnable("Whether this chunk travels with each picture.");
  for (std::uint32_t k = 0; k < kGigeChunks.size(); ++k) d.chunk(kGigeChunks[k], kGigeFirstChunkId + k);
}

void transport(Description& d) {
  const auto expert = [](const std::string& tip, bool isFixed = false) { return Description::About{tip, isFixed, "Expert"}; };
  d.category("ActionControl");
  d.integer("ActionDeviceKey", bootstrap::kActionDeviceKey, Access::ReadWrite, expert("Key that an action command must name."), range(0LL, 0xFFFFFFFFLL));
  d.fixedChoice("ActionSelector", {{"Action0", 0}}, expert("Action that the keys are about."), {"ActionGroupKey", "ActionGroupMask"});
  d.integer("ActionGroupKey", bootstrap::kActionGroupKey, Access::ReadWrite, expert("Group that an action command must name."), range(0LL, 0xFFFFFFFFLL));
  d.integer("ActionGroupMask", bootstrap::kActionGroupMask, Access::ReadWrite, expert("A bit of it must be in the command's mask."), range(0LL, 0xFFFFFFFFLL));
  d.category("TransportLayerControl");
  d.integer("PayloadSize", feature::kPayloadSize, Access::ReadOnly, {"Bytes of a picture with its chunks."}, "", "B");
  d.locked();
  d.fixedChoice("DeviceTLType", {{"GigEVision", 0}}, {"Protocol of the camera.", false, "Expert", true});
  d.integer("GevCurrentIPAddress", bootstrap::kAddress, Access::ReadOnly, expert("Address of the camera."));
  d.integer("GevCurrentSubnetMask", bootstrap::kMask, Access::ReadOnly, expert("Mask of its network."));
  d.integer("GevCurrentDefaultGateway", bootstrap::kGateway, Access::ReadOnly, expert("Gateway of its network."));
  d.bits("GevMACAddressHigh", bootstrap::kMacHigh, 16, 31, Access::ReadOnly, expert("Upper part of the hardware address."));
  d.integer("GevMACAddressLow", bootstrap::kMacLow, Access::ReadOnly, expert("Lower part of the hardware address."));
  d.integer("GevStreamChannelCount", bootstrap::kStreamChannels, Access::ReadOnly, expert("Channels that carry pictures."));
  d.integer("GevHeartbeatTimeout", bootstrap::kHeartbeat, Access::ReadWrite, expert("Silence of the client after which it has lost control."),
            range(kHeartbeatLeast_ms, kHeartbeatMost_ms), "ms");
  d.choice("GevCCP", bootstrap::kPrivilege, Access::ReadWrite, {{"OpenAccess", 0}, {"ExclusiveAccess", 1}, {"ControlAccess", 2}},
           expert("Who may control the camera."));
  d.constant("GevTimestampTickFrequency", 1'000'000'000, expert("Ticks of the clock a second."));
  d.command("GevTimestampControlLatch", bootstrap::kClockControl, kLatchClock, expert("Keeps the time of now in GevTimestampValue."));
  d.wide("GevTimestampValue", bootstrap::kClockHigh, expert("Time that was kept, TAI."), "ns");
  d.bits("GevSCPHostPort", bootstrap::kStreamPort, 16, 31, Access::ReadWrite, expert("Port that pictures are sent to; 0 closes the channel.", true),
         range(0, 65535));
  d.integer("GevSCDA", bootstrap::kDestination, Access::ReadWrite, expert("Address that pictures are sent to.", true), range(0LL, 0xFFFFFFFFLL));
  d.bits("GevSCSP", bootstrap::kSourcePort, 16, 31, Access::ReadOnly, expert("Port that pictures come from."));
  d.bits("GevSCPSPacketSize", bootstrap::kPacketSize, 16, 31, Access::ReadWrite, expert("Bytes of a packet with the headers of IP and UDP.", true),
         range(kPacketLeast, kPacketMost) + tag("Inc", std::to_string(kPacketStep)));
  d.bit("GevSCPSDoNotFragment", bootstrap::kPacketSize, 1, expert("Whether packets must arrive in one piece.", true));
  d.bitCommand("GevSCPSFireTestPacket", bootstrap::kPacketSize, 0, expert("Sends a packet of that size.", true));
  d.integer("GevSCPD", bootstrap::kPacketDelay, Access::ReadWrite, expert("Time between packets."), range(0u, kDelayMost_ns), "ns");
  d.bit("GevGVSPExtendedIDMode", bootstrap::kStreamConfiguration, 1, expert("Whether pictures are numbered with 64 bits.", true));
}

/// In the form of a GUID; the same text has the same one.
std::string guidOf(const std::string& text) {
  std::array<std::uint64_t, 2> halves{0xcbf29ce484222325u, 0x84222325cbf29ce4u};
  for (const char c : text)
    for (std::uint64_t& half : halves) half = (half ^ static_cast<unsigned char>(c)) * 0x100000001b3u;  // FNV-1a from two starts
  return print("%08X-%04X-%04X-%04X-%012llX", static_cast<unsigned>(halves[0] >> 32), static_cast<unsigned>(halves[0] >> 16 & 0xFFFF),
               static_cast<unsigned>(halves[0] & 0xFFFF), static_cast<unsigned>(halves[1] >> 48), static_cast<unsigned long long>(halves[1] & 0xFFFFFFFFFFFFu));
}

}  // namespace

std::string genicamXml(const GigeSettings& settings, const GigeAbilities& abilities) {
  Description d;
  device(d);
  image(d, settings);
  acquisition(d, settings, abilities);
  analog(d, settings, abilities);
  chunks(d);
  transport(d);
  const std::string nodes = d.nodes();
  // Clients keep descriptions by these two: another content has another version.
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<RegisterDescription ModelName=\"" + escaped(settings.model) + "\" VendorName=\"" +
         escaped(settings.vendor) +
         "\" ToolTip=\"Simulated infrared camera\" StandardNameSpace=\"GEV\" SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\" SchemaSubMinorVersion=\"0\" "
         "MajorVersion=\"1\" MinorVersion=\"0\" SubMinorVersion=\"0\" ProductGuid=\"" +
         guidOf(settings.vendor + '\n' + settings.model) + "\" VersionGuid=\"" + guidOf(nodes) +
         "\" xmlns=\"http://www.genicam.org/GenApi/Version_1_1\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xsi:schemaLocation=\"http://www.genicam.org/GenApi/Version_1_1 http://www.genicam.org/GenApi/GenApiSchema_Version_1_1.xsd\">\n" +
         nodes + "</RegisterDescription>\n";
}

}  // namespace pitviper
