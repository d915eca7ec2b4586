// The control channel of a camera on the network: whatever datagrams come, its answers are well formed, nothing goes where it may not, and it works afterwards.
#include <gtest/gtest.h>

#include <random>

#include "sim/stream/gige/genicam_xml.hpp"
#include "sim/stream/gige/gige_control.hpp"
#include "sim/stream/gige/wire.hpp"

namespace pitviper::test {
namespace {

constexpr std::uint32_t kOwn = 0x7F000001, kStranger = 0x0A000002;

/// What the rest of the camera is told, and whether that keeps the rules.
struct Watched final : GigeActions {
  GigePlan now;
  bool acquiring = false;
  long broken = 0, configured = 0, triggered = 0;
  void configure(const GigePlan& p) override {
    now = p;
    ++configured;
    broken += p.packetBytes < kPacketLeast || p.packetBytes > kPacketMost || p.delay_ns > kDelayMost_ns;
    broken += p.address != 0 && p.address != kOwn && p.address != kStranger;
  }
  void reopen() override {}
  void acquire(bool on) override { acquiring = on; }
  bool isAcquiring() const override { return acquiring; }
  void trigger(GigeTrigger) override { ++triggered; }
  void resend(const GigeResend& r) override { broken += r.last < r.first; }
  void sendTestPacket(const GigePlan& p) override { broken += !p.hasDestination(); }
  void setExposure(double us) override { broken += !(us >= 1.0 && us <= 20000.0); }
  void setGain(double dB) override { broken += !(dB >= 0.0 && dB <= 48.0); }
  std::int64_t now_ns() override { return 1; }
};

GigeSettings settings() {
  GigeSettings s;
  s.width = 64, s.height = 48, s.bits = 14, s.exposure_us = 5000, s.exposureMax_us = 20000, s.rate_hz = 50;
  return s;
}

class Requests {
 public:
  explicit Requests(std::uint64_t seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  std::vector<std::uint8_t> next() {
    std::vector<std::uint8_t> d;
    if (below(10) == 0) {
      d.resize(below(700));
      for (auto& b : d) b = static_cast<std::uint8_t>(random_());
      if (!d.empty() && below(2)) d[0] = kGvcpKey;
      return d;
    }
    constexpr std::uint16_t kCommands[] = {0x02, 0x04, 0x40, 0x80, 0x82, 0x84, 0x86, 0x100, 0x89, 0xC0, 0x41, 0x83};
    const std::uint16_t command = kCommands[below(std::size(kCommands))];
    std::vector<std::uint32_t> words;
    for (std::size_t k = below(5) ? below(5) : below(140); k > 0; --k) words.push_back(k % 2 ? value() : place());
    d.resize(8 + 4 * words.size());
    d[0] = kGvcpKey, d[1] = below(3) ? kGvcpWantsAnswer : static_cast<std::uint8_t>(random_());
    putWire16(&d[2], command), putWire16(&d[4], static_cast<std::uint16_t>(4 * words.size())), putWire16(&d[6], static_cast<std::uint16_t>(random_()));
    for (std::size_t k = 0; k < words.size(); ++k) putWire32(&d[8 + 4 * k], words[k]);
    if (below(4) == 0)
      for (std::size_t k = 1 + below(4); k > 0; --k) d[below(d.size())] ^= static_cast<std::uint8_t>(1u << below(8));
    if (below(20) == 0) d.resize(below(d.size() + 1));
    if (below(40) == 0) d.resize(d.size() + below(9));
    return d;
  }

 private:
  std::uint32_t place() {
    constexpr std::uint32_t kPlaces[] = {0x0,    0x48,   0xE8,   0x200,  0x3FC,  0x934,   0x938,   0x944,   0x960,     0xA00,  0xD00,
                                         0xD04,  0xD08,  0xD18,  0xD1C,  0x9800, 0xA000,  0xA008,  0xA010,  0xA018,    0xA020, 0xA028,
                                         0xA030, 0xA040, 0xA048, 0xA080, 0xA100, 0x10000, 0x15000, 0x1FFFC, 0xFFFFFFFC};
    return below(4) ? kPlaces[below(std::size(kPlaces))] : below(3) ? static_cast<std::uint32_t>(below(0x18000)) : static_cast<std::uint32_t>(random_());
  }
  std::uint32_t value() {
    switch (below(6)) {
      case 0:
        return 0;
      case 1:
        return 1;
      case 2:
        return 2;
      case 3:
        return static_cast<std::uint32_t>(below(65536));
      case 4:
        return kOwn;
      default:
        return static_cast<std::uint32_t>(random_());
    }
  }
  std::mt19937_64 random_;
};

TEST(FuzzGige, DatagramsOfAnyKind) {
  const GigeSettings s = settings();
  const GigeAbilities can{true, true};
  Watched actions;
  GigeTally tally;
  GigeControl control(s, can, GigeRegisters(s, {kOwn, 0xFF000000u, 9000, 4000}, genicamXml(s, can)), actions, tally);
  const GigePeer peers[] = {{kOwn, 1000}, {kOwn, 1001}, {kStranger, 1000}, {0xE0000001u, 5}, {kOwn, 0}};
  Requests requests(1);
  const char* const asked = std::getenv("PITVIPER_FUZZ");
  long answered = 0, malformedAnswers = 0;
  std::int64_t now_ms = 0;
  GigeReply reply;
  for (long k = 0, rounds = asked ? 10 * std::atol(asked) : 200000; k < rounds; ++k) {
    std::vector<std::uint8_t> d = requests.next();
    d.shrink_to_fit();  // so that a sanitizer sees a byte too far
    now_ms += requests.below(8) == 0 ? static_cast<std::int64_t>(requests.below(100)) : 0;
    control.handle(d, peers[requests.below(10) < 8 ? 0 : requests.below(5)], requests.below(8) == 0, now_ms, reply);
    if (reply.size > 0) {
      ++answered;
      malformedAnswers += reply.size > kGvcpLongest || wire16(&reply.bytes[4]) + kGvcpHead != reply.size;
    }
    if (requests.below(16) == 0) control.tick(now_ms);
    actions.broken += !control.isControlled() && (actions.now.hasDestination() || actions.acquiring);
  }
  EXPECT_EQ(actions.broken, 0) << "pictures to strangers, packets beyond their sizes, settings beyond their ranges";
  EXPECT_EQ(malformedAnswers, 0);
  EXPECT_GT(answered, 1000);
  EXPECT_GT(actions.configured, 100) << "it was not all refused";
  // And it works.
  now_ms += 1000000;
  control.tick(now_ms);
  const std::uint8_t take[] = {kGvcpKey, 1, 0, 0x82, 0, 8, 0, 9, 0, 0, 0x0A, 0, 0, 0, 0, 2};
  control.handle(take, peers[0], false, now_ms, reply);
  EXPECT_TRUE(control.isControlled());
  EXPECT_EQ(wire16(reply.bytes.data()), 0);
  const GigeCounts c = tally.now();
  EXPECT_GT(c.malformed, 0u);
  EXPECT_GT(c.refused, 0u);
}

TEST(FuzzGige, OnlyWhoControlsItMaySet) {
  const GigeSettings s = settings();
  const GigeAbilities can{true, true};
  Watched actions;
  GigeTally tally;
  GigeControl control(s, can, GigeRegisters(s, {kOwn, 0xFF000000u, 9000, 4000}, genicamXml(s, can)), actions, tally);
  const GigePeer first{kOwn, 1000}, second{kStranger, 1000};
  std::uint16_t request = 0;
  const auto write = [&](const GigePeer& who, std::uint32_t at, std::uint32_t value) {
    std::uint8_t d[16] = {kGvcpKey, 1, 0, 0x82, 0, 8};
    putWire16(&d[6], ++request), putWire32(&d[8], at), putWire32(&d[12], value);
    GigeReply reply;
    control.handle(d, who, false, request, reply);
    return static_cast<GvcpStatus>(wire16(reply.bytes.data()));
  };
  EXPECT_EQ(write(first, feature::kMode, 1), GvcpStatus::AccessDenied) << "not before it has control";
  EXPECT_EQ(write(first, bootstrap::kPrivilege, kControl), GvcpStatus::Success);
  EXPECT_EQ(write(second, bootstrap::kPrivilege, kControl), GvcpStatus::AccessDenied);
  EXPECT_EQ(write(second, bootstrap::kHeartbeat, 1000), GvcpStatus::AccessDenied);
  EXPECT_EQ(write(first, bootstrap::kDestination, kStranger), GvcpStatus::AccessDenied) << "pictures go to whom they are for";
  EXPECT_EQ(write(first, bootstrap::kDestination, kOwn), GvcpStatus::Success);
  EXPECT_EQ(write(first, feature::kWidth, 8), GvcpStatus::WriteProtect);
  EXPECT_EQ(write(first, feature::kMode + 1, 0), GvcpStatus::BadAlignment);
  EXPECT_EQ(write(first, 0xB000, 0), GvcpStatus::InvalidAddress);
  EXPECT_TRUE(actions.now.address == kOwn);
  // One who falls silent loses it, and the stream ends.
  EXPECT_EQ(write(first, bootstrap::kStreamPort, 5000), GvcpStatus::Success);
  EXPECT_EQ(write(first, feature::kStart, 1), GvcpStatus::Success);
  EXPECT_TRUE(actions.acquiring);
  control.tick(request + kHeartbeatStart_ms + 1);
  EXPECT_FALSE(control.isControlled());
  EXPECT_FALSE(actions.acquiring);
  EXPECT_EQ(tally.now().heartbeatsLost, 1u);
  EXPECT_EQ(write(second, bootstrap::kPrivilege, kControl), GvcpStatus::Success);
}

}  // namespace
}  // namespace pitviper::test
