// CIGI 3.3: bytes written out here against what is read of them, in both byte orders; what is refused; conversions against closed forms; damaged datagrams.
// PITVIPER_FUZZ sets the number of damaged datagrams, ten for each (default 2000: 20000 datagrams), PITVIPER_FUZZ_SEED the first seed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "sim/radiometry/constants.hpp"
#include "sim/stream/cigi/cigi_commands.hpp"
#include "sim/stream/cigi/cigi_packets.hpp"
#include "sim/stream/cigi/cigi_start_of_frame.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = kPi / 180.0;
/// WGS 84.
constexpr double kA_m = 6378137.0, kF = 1.0 / 298.257223563;

/// Bytes as a host of either byte order writes them.
class Datagram {
 public:
  explicit Datagram(bool big) : big_(big) {}
  Datagram& u8(int v) { return whole(static_cast<std::uint64_t>(v), 1); }
  Datagram& u16(int v) { return whole(static_cast<std::uint64_t>(v), 2); }
  Datagram& u32(std::uint32_t v) { return whole(v, 4); }
  Datagram& f32(double v) { return whole(std::bit_cast<std::uint32_t>(static_cast<float>(v)), 4); }
  Datagram& f64(double v) { return whole(std::bit_cast<std::uint64_t>(v), 8); }
  /// IG Control of frame 0x01020304 in operation.
  Datagram& control() { return u8(1).u8(24).u8(3).u8(0xfe).u8(0x3d).u8(0).u16(0x8000).u32(0x01020304).u32(0xa0b0c0d0).u32(77).u32(0); }
  Datagram& set(std::size_t at, int v) {
    bytes[at] = static_cast<std::byte>(v);
    return *this;
  }
  CigiMessage read() const { return readCigi(bytes); }
  std::vector<std::byte> bytes;

 private:
  Datagram& whole(std::uint64_t v, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(v >> 8 * (big_ ? count - 1 - i : i) & 0xff));
    return *this;
  }
  bool big_;
};

Datagram& entity(Datagram& d, int id, int flags, int parent, const glm::dvec3& rollPitchYaw_deg, const glm::dvec3& position) {
  d.u8(2).u8(48).u16(id).u8(flags).u8(0x10).u8(51).u8(0).u16(7).u16(parent);
  for (int i = 0; i < 3; ++i) d.f32(rollPitchYaw_deg[i]);
  for (int i = 0; i < 3; ++i) d.f64(position[i]);
  return d;
}

Datagram& six(Datagram& d, double x, double y, double z, double roll, double pitch, double yaw) { return d.f32(x).f32(y).f32(z).f32(roll).f32(pitch).f32(yaw); }

CigiMessage readWell(const Datagram& d) {
  CigiMessage m = d.read();
  EXPECT_EQ(m.fault, CigiFault::None) << m.words;
  EXPECT_TRUE(m.control.has_value());
  return m;
}

template <class T>
T only(const CigiMessage& m) {
  EXPECT_EQ(m.packets.size(), 1u);
  EXPECT_TRUE(m.packets.size() == 1 && std::holds_alternative<T>(m.packets[0]));
  return m.packets.size() == 1 && std::holds_alternative<T>(m.packets[0]) ? std::get<T>(m.packets[0]) : T{};
}

template <class T>
T onlyChange(const Datagram& d) {
  const auto changes = cigiChanges(readWell(d));
  EXPECT_EQ(changes.size(), 1u);
  EXPECT_TRUE(changes.size() == 1 && std::holds_alternative<T>(changes[0]));
  return changes.size() == 1 && std::holds_alternative<T>(changes[0]) ? std::get<T>(changes[0]) : T{};
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double most) {
  EXPECT_LE(glm::length(a - b), most) << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

/// Little- and big-endian.
class CigiOrders : public testing::TestWithParam<bool> {
 protected:
  Datagram start() const {
    Datagram d(GetParam());
    d.control();
    return d;
  }
};
INSTANTIATE_TEST_SUITE_P(, CigiOrders, testing::Bool(), [](const auto& which) { return which.param ? "Big" : "Little"; });

TEST_P(CigiOrders, IgControl) {
  const CigiMessage m = readWell(start());
  EXPECT_TRUE(m.packets.empty());
  EXPECT_EQ(m.control->byteOrder, GetParam() ? std::endian::big : std::endian::little);
  EXPECT_EQ(m.control->minorVersion, 3);
  EXPECT_EQ(m.control->databaseNumber, -2);
  EXPECT_EQ(m.control->mode, CigiMode::Operate);
  EXPECT_TRUE(m.control->timestampValid);
  EXPECT_TRUE(m.control->extrapolate);
  EXPECT_EQ(m.control->hostFrame, 0x01020304u);
  EXPECT_EQ(m.control->timestamp_10us, 0xa0b0c0d0u);
  EXPECT_EQ(m.control->lastIgFrame, 77u);
}

TEST_P(CigiOrders, EntityControl) {
  Datagram d = start();
  entity(d, 0x0102, 0x01 | 0x08 | 0x20, 9, {10, -20, 300}, {37.5, -122.25, 1500.5});
  const auto c = only<CigiEntityControl>(readWell(d));
  EXPECT_EQ(c.entity, 0x0102);
  EXPECT_EQ(c.state, CigiEntityState::Active);
  EXPECT_FALSE(c.attached);
  EXPECT_TRUE(c.collisions);
  EXPECT_FALSE(c.inheritAlpha);
  EXPECT_TRUE(c.extrapolate);
  EXPECT_EQ(c.clamp, CigiClamp::NonConformal);
  EXPECT_EQ(c.alpha, 51);
  EXPECT_EQ(c.type, 7);
  EXPECT_EQ(c.parent, 0) << "a parent's number means nothing of what is not attached";
  EXPECT_EQ(c.roll_deg, 10.0);
  EXPECT_EQ(c.pitch_deg, -20.0);
  EXPECT_EQ(c.yaw_deg, 300.0);
  EXPECT_EQ(c.position, (std::array<double, 3>{37.5, -122.25, 1500.5}));
}

TEST_P(CigiOrders, AttachedEntity) {
  Datagram d = start();
  entity(d, 3, 0x04 | 0x10 | 0x02, 0xfffe, {0, 0, 0}, {200.0, -300.0, 4000.0});
  const auto c = only<CigiEntityControl>(readWell(d));
  EXPECT_TRUE(c.attached);
  EXPECT_TRUE(c.inheritAlpha);
  EXPECT_EQ(c.state, CigiEntityState::Destroyed);
  EXPECT_EQ(c.parent, 0xfffe);
  EXPECT_EQ(c.position, (std::array<double, 3>{200.0, -300.0, 4000.0})) << "offsets are no latitudes";
}

TEST_P(CigiOrders, ComponentControls) {
  Datagram d = start();
  d.u8(4).u8(32).u16(0x0203).u16(0x0405).u8(13).u8(200);
  d.f32(0.25).u32(0x40091eb8).u32(0x51eb851f).u32(4).u32(0x7ff80000).u32(0xffffffff);
  d.u8(5).u8(16).u16(6).u16(7).u8(3).u8(1).f32(-2.5).u32(9);
  const CigiMessage m = readWell(d);
  ASSERT_EQ(m.packets.size(), 2u);
  const auto& full = std::get<CigiComponentControl>(m.packets[0]);
  EXPECT_EQ(full.component, 0x0203);
  EXPECT_EQ(full.instance, 0x0405);
  EXPECT_EQ(full.componentClass, CigiComponentClass::System);
  EXPECT_EQ(full.state, 200);
  EXPECT_EQ(full.wordCount, 6);
  EXPECT_EQ(full.words[5], 0xffffffffu);
  const auto& brief = std::get<CigiComponentControl>(m.packets[1]);
  EXPECT_EQ(brief.component, 6);
  EXPECT_EQ(brief.instance, 7);
  EXPECT_EQ(brief.componentClass, CigiComponentClass::Sensor);
  EXPECT_EQ(brief.state, 1);
  EXPECT_EQ(brief.wordCount, 2);
  EXPECT_EQ(brief.words, (std::array<std::uint32_t, 6>{0xc0200000u, 9, 0, 0, 0, 0}));

  const auto changes = cigiChanges(m);
  ASSERT_EQ(changes.size(), 2u);
  const auto& c = std::get<CigiComponent>(changes[0]);
  EXPECT_EQ(c.asFloat(0), 0.25);
  EXPECT_EQ(c.asFloat(4), std::nullopt) << "no number";
  EXPECT_EQ(c.asFloat(6), std::nullopt);
  EXPECT_EQ(c.asFloat(-1), std::nullopt);
  const auto& s = std::get<CigiComponent>(changes[1]);
  EXPECT_EQ(s.asFloat(0), -2.5);
  EXPECT_EQ(s.asFloat(2), std::nullopt) << "two words";
}

TEST_P(CigiOrders, PartControl) {
  Datagram d = start();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  d.u8(6).u8(32).u16(0x0304).u8(5).u8(0x01 | 0x04 | 0x10 | 0x40).u16(0);
  six(d, nan, 2.5, 1e38, -30, nan, 350);
  const auto c = only<CigiPartControl>(readWell(d));
  EXPECT_EQ(c.entity, 0x0304);
  EXPECT_EQ(c.part, 5);
  EXPECT_TRUE(c.enabled);
  EXPECT_EQ(c.given.x_m, std::nullopt) << "what is not enabled is not looked at";
  EXPECT_EQ(c.given.y_m, 2.5);
  EXPECT_EQ(c.given.z_m, std::nullopt);
  EXPECT_EQ(c.given.roll_deg, -30.0);
  EXPECT_EQ(c.given.pitch_deg, std::nullopt);
  EXPECT_EQ(c.given.yaw_deg, 350.0);
}

TEST_P(CigiOrders, ShortPartControl) {
  Datagram d = start();
  d.u8(7).u8(16).u16(0x0405).u8(8).u8(9).u8(4 | 3 << 3 | 0x80).u8(0).f32(90).f32(-12);
  const CigiMessage m = readWell(d);
  const auto c = only<CigiShortPartControl>(m);
  EXPECT_EQ(c.entity, 0x0405);
  EXPECT_EQ(c.parts[0].part, 8);
  EXPECT_EQ(c.parts[0].degree, CigiDegree::Yaw);
  EXPECT_FALSE(c.parts[0].enabled);
  EXPECT_EQ(c.parts[0].value, 90.0);
  EXPECT_EQ(c.parts[1].part, 9);
  EXPECT_EQ(c.parts[1].degree, CigiDegree::Z);
  EXPECT_TRUE(c.parts[1].enabled);
  const auto changes = cigiChanges(m);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_NEAR(std::get<CigiPart>(changes[0]).offsets.yaw_rad.value(), 0.5 * kPi, 1e-12);
  EXPECT_EQ(std::get<CigiPart>(changes[0]).offsets.up_m, std::nullopt);
  EXPECT_EQ(std::get<CigiPart>(changes[1]).offsets.up_m, 12.0) << "z is down";
  EXPECT_EQ(std::get<CigiPart>(changes[1]).offsets.yaw_rad, std::nullopt);
}

TEST_P(CigiOrders, UnusedDegreeOfAShortPartIsNotLookedAt) {
  Datagram d = start();
  d.u8(7).u8(16).u16(1).u8(2).u8(2).u8(6 | 0xc0).u8(0).f32(45).f32(std::numeric_limits<double>::infinity());
  const auto part = onlyChange<CigiPart>(d);
  EXPECT_EQ(part.part, 2);
  EXPECT_NEAR(part.offsets.roll_rad.value(), 0.25 * kPi, 1e-12);
}

TEST_P(CigiOrders, RateControl) {
  Datagram d = start();
  d.u8(8).u8(32).u16(0x0506).u8(7).u8(0x02).u16(0);
  six(d, 1.5, 2.5, 3.5, 10, 20, 30);
  const auto c = only<CigiRateControl>(readWell(d));
  EXPECT_EQ(c.entity, 0x0506);
  EXPECT_EQ(c.part, 7);
  EXPECT_FALSE(c.ofPart);
  EXPECT_TRUE(c.ownAxes);
  EXPECT_EQ(c.linear_m_s, (std::array<double, 3>{1.5, 2.5, 3.5}));
  EXPECT_EQ(c.angular_deg_s, (std::array<double, 3>{10, 20, 30}));
  auto rate = onlyChange<CigiRate>(d);
  EXPECT_EQ(rate.part, std::nullopt);
  EXPECT_TRUE(rate.ownAxes);
  expectNear(rate.linear_m_s, {1.5, -2.5, -3.5}, 0.0);
  expectNear(rate.angular_rad_s, glm::dvec3(10, -20, -30) * kDegree, 1e-15);
  d.set(24 + 5, 0x00);
  EXPECT_FALSE(onlyChange<CigiRate>(d).ownAxes);
  d.set(24 + 5, 0x01);
  rate = onlyChange<CigiRate>(d);
  EXPECT_EQ(rate.part, 7);
  EXPECT_TRUE(rate.ownAxes) << "a part's rates are in its own axes";
}

TEST_P(CigiOrders, ViewControl) {
  Datagram d = start();
  d.u8(16).u8(32).u16(0x0607).u8(0).u8(0x01 | 0x02 | 0x20).u16(0x0809);
  six(d, 3.5, 1.25, 9, 9, 9, -90);
  const auto c = only<CigiViewControl>(readWell(d));
  EXPECT_EQ(c.view, 0x0607);
  EXPECT_EQ(c.group, 0);
  EXPECT_EQ(c.entity, 0x0809);
  EXPECT_EQ(c.given.x_m, 3.5);
  EXPECT_EQ(c.given.y_m, 1.25);
  EXPECT_EQ(c.given.z_m, std::nullopt);
  EXPECT_EQ(c.given.roll_deg, std::nullopt);
  EXPECT_EQ(c.given.pitch_deg, std::nullopt);
  EXPECT_EQ(c.given.yaw_deg, -90.0);
  const auto view = onlyChange<CigiView>(d);
  EXPECT_EQ(view.offsets.forward_m, 3.5);
  EXPECT_EQ(view.offsets.left_m, -1.25);
  EXPECT_EQ(view.offsets.up_m, std::nullopt);
  expectNear(view.offsets.position(), {3.5, -1.25, 0.0}, 0.0);
  expectNear(view.offsets.orientation() * glm::dvec3(1, 0, 0), {0, 1, 0}, 1e-12);  // yaw to the left
}

TEST_P(CigiOrders, SensorControl) {
  Datagram d = start();
  d.u8(17).u8(24).u16(0x0708).u8(2).u8(0x01 | 0x02 | 0x08 | 3 << 5).u8(1).u8(0).f32(0.75).f32(0.25).f32(500).f32(1);
  const auto c = only<CigiSensorControl>(readWell(d));
  EXPECT_EQ(c.view, 0x0708);
  EXPECT_EQ(c.sensor, 2);
  EXPECT_TRUE(c.on);
  EXPECT_TRUE(c.blackHot);
  EXPECT_FALSE(c.lineDropout);
  EXPECT_TRUE(c.automaticGain);
  EXPECT_FALSE(c.trackBlack);
  EXPECT_EQ(c.trackMode, CigiTrackMode::Target);
  EXPECT_TRUE(c.extendedResponse);
  const auto s = onlyChange<CigiSensor>(d);
  EXPECT_EQ(s.sensor, 2);
  EXPECT_EQ(s.gain, 0.75);
  EXPECT_EQ(s.level, 0.25);
  EXPECT_NEAR(s.acCoupling_s, 500e-6, 1e-15);
  EXPECT_EQ(s.noise, 1.0);
  EXPECT_TRUE(s.blackHot);
}

TEST_P(CigiOrders, ViewDefinition) {
  Datagram d = start();
  d.u8(21).u8(32).u16(0x0809).u8(4).u8(0x80 | 0x20 | 0x10 | 0x08 | 0x04 | 0x01).u8(5 << 5 | 0x10 | 0x08 | 3).u8(0);
  d.f32(0.5).f32(-1).f32(-20).f32(20).f32(15).f32(-10);
  const auto c = only<CigiViewDefinitionPacket>(readWell(d));
  EXPECT_EQ(c.view, 0x0809);
  EXPECT_EQ(c.group, 4);
  EXPECT_EQ(c.mirror, CigiMirror::Vertical);
  EXPECT_EQ(c.viewType, 5);
  EXPECT_TRUE(c.toTop);
  EXPECT_TRUE(c.orthographic);
  EXPECT_EQ(c.pixelReplication, 3);
  EXPECT_EQ(c.near_m, 0.5);
  EXPECT_EQ(c.far_m, std::nullopt);
  EXPECT_EQ(c.left_deg, -20.0);
  EXPECT_EQ(c.right_deg, 20.0);
  EXPECT_EQ(c.top_deg, 15.0);
  EXPECT_EQ(c.bottom_deg, -10.0);
  const auto v = onlyChange<CigiViewDefinition>(d);
  EXPECT_NEAR(v.horizontalFieldOfView_rad().value(), 40.0 * kDegree, 1e-12);
  EXPECT_NEAR(v.top_rad.value(), 15.0 * kDegree, 1e-12);
  EXPECT_NEAR(v.bottom_rad.value(), -10.0 * kDegree, 1e-12);
}

TEST_P(CigiOrders, OtherPacketsAreSkippedBySize) {
  Datagram d = start();
  d.u8(10).u8(32);  // Atmosphere Control
  for (int i = 0; i < 30; ++i) d.u8(0xff);
  d.u8(201).u8(8).u16(0).u32(0);  // user-defined
  entity(d, 1, 1, 0, {0, 0, 0}, {0, 0, 0});
  d.u8(0).u8(8).u16(0).u32(0);
  const CigiMessage m = readWell(d);
  EXPECT_EQ(m.notServed, 3);
  ASSERT_EQ(m.packets.size(), 1u);
  EXPECT_EQ(std::get<CigiEntityControl>(m.packets[0]).entity, 1);
}

// The same bytes went through Wireshark's dissector.
TEST(Cigi, BytesWrittenByHand) {
  const unsigned char big[] = {0x01, 0x18, 0x03, 0x00, 0x31, 0x00, 0x80, 0x00, 0x00, 0x00, 0x00, 0x2a, 0x00, 0x00, 0x00, 0x00,
                               0x00, 0x00, 0x00, 0x07, 0x00, 0x00, 0x00, 0x00,                          // IG Control
                               0x02, 0x30, 0x00, 0x05, 0x01, 0x00, 0xff, 0x00, 0x00, 0x64, 0x00, 0x00,  // entity 5, active, opaque, type 100
                               0x41, 0x20, 0x00, 0x00, 0xc0, 0xa0, 0x00, 0x00, 0x42, 0xb4, 0x00, 0x00,  // roll 10, pitch -5, yaw 90
                               0x40, 0x47, 0xc0, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, 0x21, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // latitude 47.5, longitude 8.5
                               0x40, 0x8f, 0x44, 0x00, 0x00, 0x00, 0x00, 0x00};                                                 // altitude 1000.5
  const CigiMessage m = readCigi(std::as_bytes(std::span(big)));
  ASSERT_EQ(m.fault, CigiFault::None) << m.words;
  EXPECT_EQ(m.control->hostFrame, 42u);
  EXPECT_EQ(m.control->lastIgFrame, 7u);
  EXPECT_FALSE(m.control->timestampValid);
  const auto c = only<CigiEntityControl>(m);
  EXPECT_EQ(c.entity, 5);
  EXPECT_EQ(c.type, 100);
  EXPECT_EQ(c.roll_deg, 10.0);
  EXPECT_EQ(c.pitch_deg, -5.0);
  EXPECT_EQ(c.yaw_deg, 90.0);
  EXPECT_EQ(c.position, (std::array<double, 3>{47.5, 8.5, 1000.5}));
}

TEST(Cigi, StartOfFrame) {
  CigiStartOfFrame f;
  f.igFrame = 0x01020304;
  f.hostFrame = 0x05060708;
  f.databaseNumber = -3;
  f.statusCode = 9;
  f.mode = CigiMode::Operate;
  f.timestampValid = true;
  f.timestamp_10us = 0x0a0b0c0d;
  const unsigned char wanted[] = {101, 24, 3, 0xfd, 9, 0x35, 0x00, 0x80, 4, 3, 2, 1, 0x0d, 0x0c, 0x0b, 0x0a, 8, 7, 6, 5, 0, 0, 0, 0};
  const auto bytes = cigiStartOfFrame(f);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(std::to_integer<int>(bytes[i]), wanted[i]) << "byte " << i;
  EXPECT_EQ(std::to_integer<int>(cigiStartOfFrame({})[5]), 0x30) << "standby, no timestamp, WGS 84";
  f.databaseNumber = 1000;
  f.statusCode = -1;
  EXPECT_EQ(std::to_integer<int>(cigiStartOfFrame(f)[3]), 127);
  EXPECT_EQ(std::to_integer<int>(cigiStartOfFrame(f)[4]), 0);
}

/// A fault and a part of its words; no packets with it.
void expectFault(const Datagram& d, CigiFault fault, const std::string& words) {
  const CigiMessage m = d.read();
  EXPECT_EQ(m.fault, fault) << m.words;
  EXPECT_NE(m.words.find(words), std::string::npos) << m.words;
  EXPECT_TRUE(m.packets.empty());
  EXPECT_TRUE(cigiChanges(m).empty());
}

TEST(CigiFaults, OfTheBeginning) {
  Datagram whole(true);
  whole.control();
  expectFault(Datagram(true), CigiFault::TooShort, "0 bytes");
  Datagram cut = whole;
  cut.bytes.pop_back();
  expectFault(cut, CigiFault::TooShort, "23 bytes");
  Datagram other(true);
  entity(other, 1, 1, 0, {0, 0, 0}, {0, 0, 0});
  expectFault(other, CigiFault::NotIgControl, "of kind 2");
  expectFault(Datagram(whole).set(2, 4), CigiFault::WrongVersion, "CIGI 4");
  expectFault(Datagram(whole).set(2, 2).set(1, 16), CigiFault::WrongVersion, "CIGI 2");
  expectFault(Datagram(whole).set(1, 16), CigiFault::WrongVersion, "3.0 or 3.1");
  expectFault(Datagram(whole).set(4, 0x45), CigiFault::WrongVersion, "CIGI 3.4");
  EXPECT_EQ(Datagram(whole).set(4, 0x25).read().fault, CigiFault::None) << "3.2 has the same packets";
  expectFault(Datagram(whole).set(1, 32), CigiFault::WrongSize, "32 bytes");
  expectFault(Datagram(whole).set(1, 0), CigiFault::ZeroSize, "0 bytes");
  expectFault(Datagram(whole).set(6, 0x12), CigiFault::NoByteOrder, "12 00");
  expectFault(Datagram(whole).set(4, 0x33), CigiFault::OutOfRange, "IG mode 3");
}

TEST(CigiFaults, OfPackets) {
  Datagram d(false);
  d.control();
  entity(d, 1, 1, 0, {0, 0, 0}, {0, 0, 0});
  entity(d, 2, 1, 0, {0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(d.read().packets.size(), 2u);
  expectFault(Datagram(d).set(73, 0), CigiFault::ZeroSize, "Entity Control (byte 72)");
  expectFault(Datagram(d).set(73, 47), CigiFault::OddSize, "no multiple of 8");
  expectFault(Datagram(d).set(73, 1), CigiFault::OddSize, "1 bytes");
  expectFault(Datagram(d).set(73, 40), CigiFault::WrongSize, "it has 48");
  expectFault(Datagram(d).set(72, 10).set(73, 56), CigiFault::BeyondEnd, "48 are left");
  expectFault(Datagram(d).set(72, 1), CigiFault::SecondIgControl, "a second time");
  Datagram cut = d;
  cut.bytes.resize(cut.bytes.size() - 8);
  expectFault(cut, CigiFault::BeyondEnd, "40 are left");
  EXPECT_EQ(cut.read().control->hostFrame, 0x01020304u) << "for the answer";
  cut.bytes.resize(73);
  expectFault(cut, CigiFault::BeyondEnd, "no size");
  Datagram many(false);
  many.control();
  for (int i = 0; i < kMostCigiPackets - 1; ++i) many.u8(201).u8(8).u16(0).u32(0);
  EXPECT_EQ(many.read().notServed, kMostCigiPackets - 1) << many.read().words;
  many.u8(201).u8(8).u16(0).u32(0);
  expectFault(many, CigiFault::TooManyPackets, "one packet more");
}

TEST(CigiFaults, OfNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refused = [](int flags, int parent, const glm::dvec3& angles, const glm::dvec3& position, const char* words) {
    Datagram d(false);
    d.control();
    entity(d, 5, flags, parent, angles, position);
    expectFault(d, CigiFault::OutOfRange, words);
  };
  const auto taken = [](int flags, const glm::dvec3& angles, const glm::dvec3& position) {
    Datagram d(false);
    d.control();
    entity(d, 5, flags, 6, angles, position);
    EXPECT_EQ(d.read().fault, CigiFault::None) << d.read().words;
  };
  const glm::dvec3 none(0.0);
  taken(1, {180, 90, 360}, {90, 180, 0});
  taken(1, {-180, -90, -180}, {-90, -180, 0});
  taken(5, none, {9000, -9000, 9000});
  refused(1, 0, none, {90.000001, 0, 0}, "latitude 90.000001 is outside of -90 to 90");
  refused(1, 0, none, {nan, 0, 0}, "latitude nan");
  refused(1, 0, none, {0, -361, 0}, "longitude -361");
  refused(1, 0, none, {0, 0, infinity}, "altitude inf");
  refused(1, 0, none, {0, 0, -1e9}, "altitude");
  refused(5, 0, none, {0, 2e9, 0}, "y offset");
  refused(1, 0, {nan, 0, 0}, none, "roll nan");
  refused(1, 0, {0, 91, 0}, none, "pitch 91");
  refused(1, 0, {0, 0, 361}, none, "yaw 361");
  refused(3, 0, none, none, "entity state 3");
  refused(1 | 0x60, 0, none, none, "ground clamp 3");
  refused(5, 5, none, none, "entity 5 is attached to itself");

  Datagram sensor(true);
  sensor.control().u8(17).u8(24).u16(0).u8(0).u8(1).u8(0).u8(0).f32(1.01).f32(0).f32(0).f32(0);
  expectFault(sensor, CigiFault::OutOfRange, "gain 1.00999999");
  Datagram coupling(true);
  coupling.control().u8(17).u8(24).u16(0).u8(0).u8(1).u8(0).u8(0).f32(1).f32(0).f32(infinity).f32(0);
  expectFault(coupling, CigiFault::OutOfRange, "AC coupling inf");
  Datagram component(true);
  component.control().u8(5).u8(16).u16(0).u16(0).u8(16).u8(0).u32(0).u32(0);
  expectFault(component, CigiFault::OutOfRange, "component class 16");
  Datagram part(true);
  part.control().u8(7).u8(16).u16(0).u8(0).u8(0).u8(7).u8(0).u32(0).u32(0);
  expectFault(part, CigiFault::OutOfRange, "degree of freedom 7");
  Datagram view(true);
  view.control().u8(21).u8(32).u16(0).u8(0).u8(0x0c).u8(0).u8(0).f32(0).f32(0).f32(20).f32(20).f32(0).f32(0);
  expectFault(view, CigiFault::OutOfRange, "left is not below right");
  Datagram wide(true);
  wide.control().u8(21).u8(32).u16(0).u8(0).u8(0x08).u8(0).u8(0).f32(0).f32(0).f32(0).f32(90).f32(0).f32(0);
  expectFault(wide, CigiFault::OutOfRange, "right half-angle 90");
  Datagram rate(true);
  rate.control().u8(8).u8(32).u16(0).u8(0).u8(0).u16(0);
  six(rate, 0, 0, nan, 0, 0, 0);
  expectFault(rate, CigiFault::OutOfRange, "linear rate nan");
}

CigiEntityPose pose(const glm::dvec3& rollPitchYaw_deg, const glm::dvec3& position, bool attached = false) {
  Datagram d(true);
  d.control();
  entity(d, 1, attached ? 5 : 1, 2, rollPitchYaw_deg, position);
  return onlyChange<CigiEntityPose>(d);
}

// Earth-centred axes: x to longitude 0 on the equator, y to 90 deg east, z to the north pole. There, north is z, east is y, up is x.
TEST(CigiPoses, AtTheEquatorTheyAreAxes) {
  const auto level = pose({0, 0, 0}, {0, 0, 1000});
  EXPECT_FALSE(level.attached);
  expectNear(level.position, {kA_m + 1000, 0, 0}, 1e-6);
  EXPECT_EQ(level.geodetic.height_m, 1000.0);
  expectNear(level.orientation * glm::dvec3(1, 0, 0), {0, 0, 1}, 1e-12);   // forward is north
  expectNear(level.orientation * glm::dvec3(0, 1, 0), {0, -1, 0}, 1e-12);  // left is west
  expectNear(level.orientation * glm::dvec3(0, 0, 1), {1, 0, 0}, 1e-12);   // up
  const auto east = pose({0, 0, 90}, {0, 0, 0});
  expectNear(east.orientation * glm::dvec3(1, 0, 0), {0, 1, 0}, 1e-12);
  expectNear(east.orientation * glm::dvec3(0, 1, 0), {0, 0, 1}, 1e-12);
  const auto climbing = pose({0, 30, 0}, {0, 0, 0});
  expectNear(climbing.orientation * glm::dvec3(1, 0, 0), {0.5, 0, std::sqrt(0.75)}, 1e-12);
  const auto banked = pose({30, 0, 0}, {0, 0, 0});
  expectNear(banked.orientation * glm::dvec3(0, -1, 0), {-0.5, std::sqrt(0.75), 0}, 1e-12);  // the right wing is east, and down
  expectNear(banked.orientation * glm::dvec3(1, 0, 0), {0, 0, 1}, 1e-12);
}

/// CIGI's own: z y x turns by yaw, pitch and roll, from axes x forward, y right, z down to north, east, down.
glm::dmat3 northEastDown(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch), cy = std::cos(yaw), sy = std::sin(yaw);
  return {glm::dvec3(cp * cy, cp * sy, -sp), glm::dvec3(sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp),
          glm::dvec3(cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp)};
}

TEST(CigiPoses, AnywhereAsMatricesOfTurnsGiveThem) {
  const double latitude = 47.5 * kDegree, longitude = -122.25 * kDegree, height = 2345.0;
  const auto p = pose({25, -35, 210}, {47.5, -122.25, height});
  const double sinLat = std::sin(latitude), cosLat = std::cos(latitude), sinLon = std::sin(longitude), cosLon = std::cos(longitude);
  const double e2 = kF * (2 - kF), n = kA_m / std::sqrt(1 - e2 * sinLat * sinLat);
  expectNear(p.position, {(n + height) * cosLat * cosLon, (n + height) * cosLat * sinLon, (n * (1 - e2) + height) * sinLat}, 1e-6);
  const glm::dmat3 ecefFromNed(glm::dvec3(-sinLat * cosLon, -sinLat * sinLon, cosLat), glm::dvec3(-sinLon, cosLon, 0),
                               glm::dvec3(-cosLat * cosLon, -cosLat * sinLon, -sinLat));
  const glm::dmat3 theirs = ecefFromNed * northEastDown(25 * kDegree, -35 * kDegree, 210 * kDegree);
  const glm::dmat3 ours = glm::mat3_cast(p.orientation);
  expectNear(ours[0], theirs[0], 1e-12);
  expectNear(ours[1], -theirs[1], 1e-12);
  expectNear(ours[2], -theirs[2], 1e-12);
}

TEST(CigiPoses, AttachedOnesAreInTheParentsAxes) {
  const auto p = pose({20, 10, -40}, {10, 2, 3}, true);
  EXPECT_TRUE(p.attached);
  EXPECT_EQ(p.parent, 2);
  expectNear(p.position, {10, -2, -3}, 0.0);
  const glm::dmat3 theirs = northEastDown(20 * kDegree, 10 * kDegree, -40 * kDegree), ours = glm::mat3_cast(p.orientation);
  const glm::dvec3 flip(1, -1, -1);
  expectNear(ours[0], flip * theirs[0], 1e-12);
  expectNear(ours[1], -flip * theirs[1], 1e-12);
  expectNear(ours[2], -flip * theirs[2], 1e-12);
  expectNear(pose({0, 0, 0}, {0, 0, 0}, true).orientation * glm::dvec3(1, 2, 3), {1, 2, 3}, 1e-12);
  EXPECT_NEAR(p.alpha, 0.2, 1e-15);
  EXPECT_EQ(p.state, CigiEntityState::Active);
  EXPECT_EQ(p.type, 7);
}

TEST(CigiPoses, OffsetsNotGivenStay) {
  CigiOffsets held;
  held.take({1.0, 2.0, std::nullopt, 0.5, std::nullopt, std::nullopt});
  held.take({std::nullopt, 5.0, 6.0, std::nullopt, 0.25, std::nullopt});
  expectNear(held.position(), {1, 5, 6}, 0.0);
  EXPECT_EQ(held.yaw_rad, 0.5);
  EXPECT_EQ(held.pitch_rad, 0.25);
  const glm::dvec3 forward = held.orientation() * glm::dvec3(1, 0, 0);
  expectNear(forward, {std::cos(0.25) * std::cos(0.5), -std::cos(0.25) * std::sin(0.5), std::sin(0.25)}, 1e-12);
}

long long fromEnvironment(const char* name, long long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoll(text);
}

/// One of every packet.
Datagram everything(bool big) {
  Datagram d(big);
  d.control();
  entity(d, 1, 1, 0, {1, 2, 3}, {4, 5, 6});
  entity(d, 2, 5, 1, {1, 2, 3}, {4, 5, 6});
  d.u8(4).u8(32).u16(1).u16(2).u8(3).u8(4).u32(1).u32(2).u32(3).u32(4).u32(5).u32(6);
  d.u8(5).u8(16).u16(1).u16(2).u8(3).u8(4).u32(1).u32(2);
  d.u8(6).u8(32).u16(1).u8(2).u8(0x7f).u16(0);
  six(d, 1, 2, 3, 4, 5, 6);
  d.u8(7).u8(16).u16(1).u8(2).u8(3).u8(0xca).u8(0).f32(1).f32(2);
  d.u8(8).u8(32).u16(1).u8(2).u8(3).u16(0);
  six(d, 1, 2, 3, 4, 5, 6);
  d.u8(16).u8(32).u16(1).u8(2).u8(0x3f).u16(3);
  six(d, 1, 2, 3, 4, 5, 6);
  d.u8(17).u8(24).u16(1).u8(2).u8(0x0f).u8(1).u8(0).f32(0.1).f32(0.2).f32(0.3).f32(0.4);
  d.u8(21).u8(32).u16(1).u8(2).u8(0x3f).u8(0).u8(0).f32(1).f32(2).f32(-3).f32(4).f32(5).f32(-6);
  d.u8(10).u8(8).u16(0).u32(0);
  return d;
}

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool isTurn(const glm::dquat& q) { return std::abs(glm::length(q) - 1.0) < 1e-9; }

/// All that is said of changes holds.
bool isSound(const CigiChange& change) {
  const auto offsets = [](const CigiOffsets& o) { return finite(o.position()) && isTurn(o.orientation()); };
  if (const auto* p = std::get_if<CigiEntityPose>(&change)) return finite(p->position) && isTurn(p->orientation) && p->alpha >= 0.0 && p->alpha <= 1.0;
  if (const auto* v = std::get_if<CigiView>(&change)) return offsets(v->offsets);
  if (const auto* p = std::get_if<CigiPart>(&change)) return offsets(p->offsets);
  if (const auto* r = std::get_if<CigiRate>(&change)) return finite(r->linear_m_s) && finite(r->angular_rad_s);
  if (const auto* s = std::get_if<CigiSensor>(&change)) return s->gain >= 0.0 && s->gain <= 1.0 && s->level <= 1.0 && std::isfinite(s->acCoupling_s);
  if (const auto* d = std::get_if<CigiViewDefinition>(&change)) {
    const auto horizontal = d->horizontalFieldOfView_rad();
    return !horizontal || (*horizontal > 0.0 && *horizontal < kPi);
  }
  const auto& c = std::get<CigiComponent>(change);
  bool sound = c.wordCount <= 6;
  for (int i = -1; i < 7; ++i) sound = sound && std::isfinite(c.asFloat(i).value_or(0.0));
  return sound;
}

TEST(CigiFuzz, DamagedDatagramsAreReadOrRefused) {
  const long long count = 10 * fromEnvironment("PITVIPER_FUZZ", 2000);
  const auto seed = static_cast<std::uint64_t>(fromEnvironment("PITVIPER_FUZZ_SEED", 1));
  const Datagram whole[2] = {everything(false), everything(true)};
  for (const Datagram& d : whole) {
    ASSERT_EQ(d.read().fault, CigiFault::None) << d.read().words;
    ASSERT_EQ(d.read().packets.size(), 10u);
    ASSERT_EQ(cigiChanges(d.read()).size(), 11u);
  }
  long long taken = 0, unsound = 0;
  for (long long i = 0; i < count; ++i) {
    std::mt19937_64 random(seed + static_cast<std::uint64_t>(i));
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    // Its own allocation of its own size: a sanitizer sees a byte too far.
    std::vector<std::byte> bytes = whole[below(2)].bytes;
    if (below(8) == 0) {
      bytes.resize(below(600));
      for (auto& b : bytes) b = static_cast<std::byte>(random());
    } else {
      for (std::size_t n = below(4); n > 0; --n) bytes[below(bytes.size())] = static_cast<std::byte>(below(3) == 0 ? 0xff * below(2) : below(256));
      if (below(4) == 0) bytes.resize(below(bytes.size() + 1));
      if (below(6) == 0) {  // packets of one in another's place
        const std::size_t from = below(bytes.size() + 1);
        const std::vector<std::byte> tail(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end());
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size() + 1)), tail.begin(), tail.end());
      }
    }
    bytes.shrink_to_fit();
    const CigiMessage m = readCigi(bytes);
    const auto changes = cigiChanges(m);
    bool sound = true;
    if (m.fault == CigiFault::None) {
      ++taken;
      sound = m.control.has_value() && m.words.empty() && m.packets.size() <= static_cast<std::size_t>(kMostCigiPackets);
      for (const auto& change : changes) sound = sound && isSound(change);
    } else {
      sound = m.packets.empty() && changes.empty() && !m.words.empty() && m.words.size() < 300;
      for (const char c : m.words) sound = sound && c >= ' ' && c <= '~';
    }
    if (!sound && ++unsound < 5) ADD_FAILURE() << "seed " << seed + static_cast<std::uint64_t>(i) << ": " << m.words;
  }
  std::printf("%lld damaged datagrams from seed %llu: %lld taken, %lld refused, %lld unsound\n", count, static_cast<unsigned long long>(seed), taken,
              count - taken, unsound);
  EXPECT_EQ(unsound, 0);
  EXPECT_GT(taken, count / 10) << "everything is refused";
  EXPECT_GT(count - taken, count / 10) << "the damage does not damage";
}

}  // namespace
}  // namespace pitviper
