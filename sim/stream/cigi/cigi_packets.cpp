#include "sim/stream/cigi/cigi_packets.hpp"

#include <limits>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr int kIgControl = 1;
constexpr std::size_t kIgControlSize = 24;
/// Every packet has a number of whole 8 bytes.
constexpr std::size_t kUnit = 8;
/// A turn: hosts write a heading as 0 to 360 or as -180 to 180 degrees, whatever a field asks for. More is a slip of units.
constexpr double kTurn_deg = 360.0;
/// As of positions, heights and velocities in scenarios (scene/placement), which this file needs not otherwise.
constexpr double kFarthest_m = 1e9, kLowest_m = -20000.0, kHighest_m = 1e8, kFastest_m_s = 1e6;
/// 170000 turns a minute: faster than any rotor.
constexpr double kFastestTurn_deg_s = 1e6;
/// A half-angle stays below 90 deg, by a float's step or so.
constexpr double kWidestHalf_deg = 89.99999;

/// The fields of one packet, in the datagram's byte order, and the first that is wrong. Offsets are within the size that was checked.
class Fields {
 public:
  Fields(std::span<const std::byte> bytes, bool bigEndian) : bytes_(bytes), bigEndian_(bigEndian) {}
  int u8(std::size_t at) const { return std::to_integer<int>(bytes_[at]); }
  int u16(std::size_t at) const { return static_cast<int>(whole(at, 2)); }
  std::uint32_t u32(std::size_t at) const { return static_cast<std::uint32_t>(whole(at, 4)); }
  int bits(std::size_t at, int first, int count) const { return (u8(at) >> first) & ((1 << count) - 1); }
  bool bit(std::size_t at, int which) const { return bits(at, which, 1) != 0; }

  template <class Enum>
  Enum choice(const char* name, int value, Enum last) {
    return static_cast<Enum>(static_cast<int>(within(name, value, 0.0, static_cast<double>(last))));
  }
  double f32(const char* name, std::size_t at, double least, double most) { return within(name, std::bit_cast<float>(u32(at)), least, most); }
  double f64(const char* name, std::size_t at, double least, double most) { return within(name, std::bit_cast<double>(whole(at, 8)), least, most); }
  std::optional<double> f32If(bool given, const char* name, std::size_t at, double least, double most) {
    return given ? std::optional<double>(f32(name, at, least, most)) : std::nullopt;
  }

  void refuse(const std::string& words) {
    if (problem_.empty()) problem_ = words;
  }
  const std::string& problem() const { return problem_; }

 private:
  std::uint64_t whole(std::size_t at, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | std::to_integer<std::uint64_t>(bytes_[at + (bigEndian_ ? i : count - 1 - i)]);
    return value;
  }
  double within(const char* name, double value, double least, double most) {
    if (value >= least && value <= most) return value;  // false of a NaN
    refuse(print("%s %.9g is outside of %.9g to %.9g", name, value, least, most));
    return least;
  }
  std::span<const std::byte> bytes_;
  bool bigEndian_;
  std::string problem_;
};

CigiIgControl readIgControl(Fields& f, bool bigEndian) {
  CigiIgControl c;
  c.byteOrder = bigEndian ? std::endian::big : std::endian::little;
  c.databaseNumber = f.u8(3) < 128 ? f.u8(3) : f.u8(3) - 256;
  c.minorVersion = f.bits(4, 4, 4);
  c.extrapolate = f.bit(4, 3);
  c.timestampValid = f.bit(4, 2);
  c.mode = f.choice("IG mode", f.bits(4, 0, 2), CigiMode::Debug);
  c.hostFrame = f.u32(8);
  c.timestamp_10us = f.u32(12);
  c.lastIgFrame = f.u32(16);
  return c;
}

CigiPacket readEntity(Fields& f) {
  CigiEntityControl c;
  c.entity = f.u16(2);
  c.state = f.choice("entity state", f.bits(4, 0, 2), CigiEntityState::Destroyed);
  c.attached = f.bit(4, 2);
  c.collisions = f.bit(4, 3);
  c.inheritAlpha = f.bit(4, 4);
  c.clamp = f.choice("ground clamp", f.bits(4, 5, 2), CigiClamp::Conformal);
  c.extrapolate = f.bit(5, 4);
  c.alpha = f.u8(6);
  c.type = f.u16(8);
  if (c.attached) c.parent = f.u16(10);
  if (c.attached && c.parent == c.entity) f.refuse("entity " + std::to_string(c.entity) + " is attached to itself");
  c.roll_deg = f.f32("roll", 12, -kTurn_deg, kTurn_deg);
  c.pitch_deg = f.f32("pitch", 16, -90.0, 90.0);
  c.yaw_deg = f.f32("yaw", 20, -kTurn_deg, kTurn_deg);
  if (c.attached)
    c.position = {f.f64("x offset", 24, -kFarthest_m, kFarthest_m), f.f64("y offset", 32, -kFarthest_m, kFarthest_m),
                  f.f64("z offset", 40, -kFarthest_m, kFarthest_m)};
  else c.position = {f.f64("latitude", 24, -90.0, 90.0), f.f64("longitude", 32, -kTurn_deg, kTurn_deg), f.f64("altitude", 40, kLowest_m, kHighest_m)};
  return c;
}

CigiPacket readAnyComponent(Fields& f, int wordCount) {
  CigiComponentControl c;
  c.component = f.u16(2);
  c.instance = f.u16(4);
  c.componentClass = f.choice("component class", f.bits(6, 0, 6), CigiComponentClass::Symbol);
  c.state = f.u8(7);
  c.wordCount = wordCount;
  for (std::size_t i = 0; i < static_cast<std::size_t>(wordCount); ++i) c.words[i] = f.u32(8 + 4 * i);
  return c;
}
CigiPacket readComponent(Fields& f) { return readAnyComponent(f, 6); }
CigiPacket readShortComponent(Fields& f) { return readAnyComponent(f, 2); }

/// Six floats from byte 8 on; the first of six enabling bits is this one of byte 5.
CigiDegreesGiven readDegrees(Fields& f, int firstBit) {
  CigiDegreesGiven d;
  d.x_m = f.f32If(f.bit(5, firstBit), "x offset", 8, -kFarthest_m, kFarthest_m);
  d.y_m = f.f32If(f.bit(5, firstBit + 1), "y offset", 12, -kFarthest_m, kFarthest_m);
  d.z_m = f.f32If(f.bit(5, firstBit + 2), "z offset", 16, -kFarthest_m, kFarthest_m);
  d.roll_deg = f.f32If(f.bit(5, firstBit + 3), "roll", 20, -kTurn_deg, kTurn_deg);
  d.pitch_deg = f.f32If(f.bit(5, firstBit + 4), "pitch", 24, -kTurn_deg, kTurn_deg);
  d.yaw_deg = f.f32If(f.bit(5, firstBit + 5), "yaw", 28, -kTurn_deg, kTurn_deg);
  return d;
}

CigiPacket readPart(Fields& f) {
  CigiPartControl c;
  c.entity = f.u16(2);
  c.part = f.u8(4);
  c.enabled = f.bit(5, 0);
  c.given = readDegrees(f, 1);
  return c;
}

CigiPacket readShortPart(Fields& f) {
  CigiShortPartControl c;
  c.entity = f.u16(2);
  for (int i = 0; i < 2; ++i) {
    auto& p = c.parts[static_cast<std::size_t>(i)];
    p.part = f.u8(4 + static_cast<std::size_t>(i));
    p.degree = f.choice("degree of freedom", f.bits(6, 3 * i, 3), CigiDegree::Roll);
    p.enabled = f.bit(6, 6 + i);
    const bool turns = p.degree >= CigiDegree::Yaw;
    const double most = turns ? kTurn_deg : kFarthest_m;
    if (p.degree != CigiDegree::None) p.value = f.f32(turns ? "angle" : "offset", 8 + 4 * static_cast<std::size_t>(i), -most, most);
  }
  return c;
}

CigiPacket readRate(Fields& f) {
  CigiRateControl c;
  c.entity = f.u16(2);
  c.part = f.u8(4);
  c.ofPart = f.bit(5, 0);
  c.ownAxes = f.bit(5, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    c.linear_m_s[i] = f.f32("linear rate", 8 + 4 * i, -kFastest_m_s, kFastest_m_s);
    c.angular_deg_s[i] = f.f32("angular rate", 20 + 4 * i, -kFastestTurn_deg_s, kFastestTurn_deg_s);
  }
  return c;
}

CigiPacket readView(Fields& f) {
  CigiViewControl c;
  c.view = f.u16(2);
  c.group = f.u8(4);
  c.entity = f.u16(6);
  c.given = readDegrees(f, 0);
  return c;
}

CigiPacket readSensor(Fields& f) {
  CigiSensorControl c;
  c.view = f.u16(2);
  c.sensor = f.u8(4);
  c.on = f.bit(5, 0);
  c.blackHot = f.bit(5, 1);
  c.lineDropout = f.bit(5, 2);
  c.automaticGain = f.bit(5, 3);
  c.trackBlack = f.bit(5, 4);
  c.trackMode = static_cast<CigiTrackMode>(f.bits(5, 5, 3));
  c.extendedResponse = f.bit(6, 0);
  c.gain = f.f32("gain", 8, 0.0, 1.0);
  c.level = f.f32("level", 12, 0.0, 1.0);
  c.acCoupling_us = f.f32("AC coupling", 16, 0.0, std::numeric_limits<float>::max());
  c.noise = f.f32("noise", 20, 0.0, 1.0);
  return c;
}

/// A half-angle is below its opposite: some hosts send both above zero.
void checkOpposites(Fields& f, const char* lower, const std::optional<double>& least, const char* upper, const std::optional<double>& most) {
  if (least && most && *least >= *most) f.refuse(std::string(lower) + " is not below " + upper + ": " + lower + " half-angles are negative");
}

CigiPacket readViewDefinition(Fields& f) {
  CigiViewDefinitionPacket c;
  c.view = f.u16(2);
  c.group = f.u8(4);
  c.mirror = static_cast<CigiMirror>(f.bits(5, 6, 2));
  c.pixelReplication = f.bits(6, 0, 3);
  c.orthographic = f.bit(6, 3);
  c.toTop = f.bit(6, 4);
  c.viewType = f.bits(6, 5, 3);
  constexpr double farthest_m = std::numeric_limits<float>::max();
  c.near_m = f.f32If(f.bit(5, 0), "near plane", 8, 0.0, farthest_m);
  c.far_m = f.f32If(f.bit(5, 1), "far plane", 12, 0.0, farthest_m);
  c.left_deg = f.f32If(f.bit(5, 2), "left half-angle", 16, -kWidestHalf_deg, kWidestHalf_deg);
  c.right_deg = f.f32If(f.bit(5, 3), "right half-angle", 20, -kWidestHalf_deg, kWidestHalf_deg);
  c.top_deg = f.f32If(f.bit(5, 4), "top half-angle", 24, -kWidestHalf_deg, kWidestHalf_deg);
  c.bottom_deg = f.f32If(f.bit(5, 5), "bottom half-angle", 28, -kWidestHalf_deg, kWidestHalf_deg);
  checkOpposites(f, "left", c.left_deg, "right", c.right_deg);
  checkOpposites(f, "bottom", c.bottom_deg, "top", c.top_deg);
  return c;
}

/// A kind that is served.
struct Kind {
  int id;
  const char* name;
  std::size_t size;
  CigiPacket (*read)(Fields&);
};
constexpr Kind kKinds[] = {{2, "Entity Control", 48, readEntity},
                           {4, "Component Control", 32, readComponent},
                           {5, "Short Component Control", 16, readShortComponent},
                           {6, "Articulated Part Control", 32, readPart},
                           {7, "Short Articulated Part Control", 16, readShortPart},
                           {8, "Rate Control", 32, readRate},
                           {16, "View Control", 32, readView},
                           {17, "Sensor Control", 24, readSensor},
                           {21, "View Definition", 32, readViewDefinition}};

const Kind* kindOf(int id) {
  for (const Kind& kind : kKinds)
    if (kind.id == id) return &kind;
  return nullptr;
}

/// What is wrong, and how it is said.
struct Trouble {
  CigiFault fault = CigiFault::None;
  std::string words;
};

/// Of a datagram's beginning; its byte order where all is well.
Trouble checkBeginning(std::span<const std::byte> d, bool& bigEndian) {
  const auto byteAt = [&](std::size_t i) { return std::to_integer<int>(d[i]); };
  const std::string whole = std::to_string(kIgControlSize);
  if (d.size() < kIgControlSize) return {CigiFault::TooShort, "the datagram has " + std::to_string(d.size()) + " bytes: an IG Control alone has " + whole};
  if (byteAt(0) != kIgControl)
    return {CigiFault::NotIgControl, "the first packet is of kind " + std::to_string(byteAt(0)) + ": a datagram begins with an IG Control (1)"};
  // Before its size, which is another in earlier versions: 16 bytes in 3.0 and 3.1.
  const int size = byteAt(1), major = byteAt(2), minor = byteAt(4) >> 4;
  const std::string understood = ": 3.3 (or 3.2) is understood";
  if (major != 3) return {CigiFault::WrongVersion, "the host speaks CIGI " + std::to_string(major) + understood};
  if (size == 16) return {CigiFault::WrongVersion, "the host speaks CIGI 3.0 or 3.1" + understood};
  if (size != static_cast<int>(kIgControlSize))
    return {size == 0 ? CigiFault::ZeroSize : CigiFault::WrongSize, "IG Control (byte 0) says that it has " + std::to_string(size) + " bytes: it has " + whole};
  if (minor != 2 && minor != 3) return {CigiFault::WrongVersion, "the host speaks CIGI 3." + std::to_string(minor) + understood};
  const int magic = byteAt(6) << 8 | byteAt(7);
  if (magic != 0x8000 && magic != 0x0080) {
    return {CigiFault::NoByteOrder, print("IG Control (byte 6) has %02x %02x for a byte order: 80 00 or 00 80", byteAt(6), byteAt(7))};
  }
  bigEndian = magic == 0x8000;
  return {};
}

std::string nameOf(int id) {
  if (const Kind* kind = kindOf(id)) return kind->name;
  return id == kIgControl ? "IG Control" : "a packet of kind " + std::to_string(id);
}

/// Of the packet that begins what is left of a datagram.
Trouble checkHeader(std::span<const std::byte> left) {
  if (left.size() < 2) return {CigiFault::BeyondEnd, " has no size: the datagram ends"};
  const int id = std::to_integer<int>(left[0]);
  const std::size_t size = std::to_integer<std::size_t>(left[1]);
  const std::string says = " says that it has " + std::to_string(size) + " bytes: ";
  if (size == 0) return {CigiFault::ZeroSize, says + "no packet is without"};
  if (size % kUnit != 0) return {CigiFault::OddSize, says + "no multiple of 8"};
  if (id == kIgControl) return {CigiFault::SecondIgControl, " comes a second time: a datagram has one"};
  if (const Kind* kind = kindOf(id); kind != nullptr && size != kind->size) return {CigiFault::WrongSize, says + "it has " + std::to_string(kind->size)};
  if (size > left.size()) return {CigiFault::BeyondEnd, says + std::to_string(left.size()) + " are left of the datagram"};
  return {};
}

/// Without what was read before: a frame is taken as a whole or not at all.
CigiMessage refused(CigiMessage message, const Trouble& trouble, int id, std::size_t at) {
  message.packets.clear();
  message.fault = trouble.fault;
  message.words = nameOf(id) + " (byte " + std::to_string(at) + ")" + trouble.words;
  return message;
}

}  // namespace

CigiMessage readCigi(std::span<const std::byte> datagram) {
  CigiMessage message;
  bool bigEndian = false;
  if (const Trouble trouble = checkBeginning(datagram, bigEndian); trouble.fault != CigiFault::None) {
    message.fault = trouble.fault;
    message.words = trouble.words;
    return message;
  }
  Fields first(datagram.first(kIgControlSize), bigEndian);
  const CigiIgControl control = readIgControl(first, bigEndian);
  if (!first.problem().empty()) return refused(message, {CigiFault::OutOfRange, ": " + first.problem()}, kIgControl, 0);
  message.control = control;

  int count = 1;
  for (std::size_t at = kIgControlSize; at < datagram.size(); ++count) {
    const auto left = datagram.subspan(at);
    const int id = std::to_integer<int>(left[0]);
    if (count == kMostCigiPackets) return refused(message, {CigiFault::TooManyPackets, " is one packet more than is read of a datagram"}, id, at);
    if (const Trouble trouble = checkHeader(left); trouble.fault != CigiFault::None) return refused(message, trouble, id, at);
    const std::size_t size = std::to_integer<std::size_t>(left[1]);
    if (const Kind* kind = kindOf(id)) {
      Fields fields(left.first(size), bigEndian);
      message.packets.push_back(kind->read(fields));
      if (!fields.problem().empty()) return refused(message, {CigiFault::OutOfRange, ": " + fields.problem()}, id, at);
    } else {
      ++message.notServed;
    }
    at += size;
  }
  return message;
}

}  // namespace pitviper
