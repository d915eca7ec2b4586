// A servo that would be stepped through for minutes is refused where it is asked for.
#include <gtest/gtest.h>

#include "sim/parameters/error.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string refusal(const std::string& rate, const std::string& gimbal, int frames = 3) {
  try {
    (void)scene("time: {rate: " + rate + print(", frames: %d}\n", frames) +
                "cameras:\n- {name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], look_at: [9 km, 0 m, 0 m],\n   gimbal: " + gimbal +
                ", channels: [{name: x, response: {band: [3 um, 5 um]}}]}\n");
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(GimbalServo, IsRefusedWhereItWouldTakeMinutes) {
  for (const char* gimbal : {"{rate: 10 deg/s}", "{lag: 10 ms, jitter: {rms: 20 urad, corner: 20 Hz}}", "{acceleration: 3 deg/s2}", "{bandwidth: 5 Hz, scan: {pattern: conical, radius: 1 deg, frequency: 1e-6 Hz}}"})
    for (const char* rate : {"1e-6 Hz", "1e-5 Hz", "9e-4 Hz"}) {
      const std::string said = refusal(rate, gimbal);
      EXPECT_NE(said.find(":4:12: a gimbal with a lag or limits of rate or acceleration"), std::string::npos) << said;
      EXPECT_NE(said.find("expected frames at most 1000 s apart"), std::string::npos) << said;
    }
  const std::string longest = refusal("0.01 Hz", "{rate: 10 deg/s}", 2000);
  EXPECT_NE(longest.find("1.999e+05 s from the first frame to the last; expected at most 1e+05 s in all"), std::string::npos) << longest;
}

// What no servo steps through is read at any rate: jitter and scans are functions of time alone.
TEST(GimbalServo, WhatFollowsAtOnceIsNot) {
  for (const char* gimbal : {"{}", "{jitter: {rms: 20 urad, corner: 1e-6 Hz}}", "{jitter: {rms: 20 urad, corner: 1e6 Hz}}", "{scan: {pattern: conical, radius: 1 deg, frequency: 1e6 Hz}}",
                             "{jitter: {spectrum: [[1e-6 Hz, 1 urad2/Hz], [1e6 Hz, 1 urad2/Hz]]}}"})
    for (const char* rate : {"1e-6 Hz", "25 Hz"}) EXPECT_EQ(refusal(rate, gimbal), "") << gimbal;
  EXPECT_EQ(refusal("0.001 Hz", "{rate: 10 deg/s}"), "");
  EXPECT_EQ(refusal("25 Hz", "{rate: 10 deg/s}", 2000000), "");
}

}  // namespace
}  // namespace pitviper::test
