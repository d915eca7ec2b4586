// A servo that would be stepped through for minutes is refused where it is asked for.
#include <gtest/gtest.h>

#include "sim/parameters/error.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

std::string refusal(const std::string& rate, const std::string& gimbal, int frames = 3, const std::string& camera = "") {
  try {
    (void)scene("time: {rate: " + rate + print(", frames: %d}\n", frames) + "cameras:\n- {name: c, " + camera +
                "film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], look_at: [9 km, 0 m, 0 m],\n   gimbal: " +
                gimbal + ", channels: [{name: x, response: {band: [3 um, 5 um]}}]}\n");
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

TEST(GimbalServo, IsRefusedWhereItWouldTakeMinutes) {
  for (const char* gimbal : {"{rate: 10 deg/s}", "{lag: 10 ms, jitter: {rms: 20 urad, corner: 20 Hz}}", "{acceleration: 3 deg/s2}",
                             "{bandwidth: 5 Hz, scan: {pattern: conical, radius: 1 deg, frequency: 1e-6 Hz}}"})
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
  for (const char* gimbal :
       {"{}", "{jitter: {rms: 20 urad, corner: 1e-6 Hz}}", "{jitter: {rms: 20 urad, corner: 1e6 Hz}}",
        "{scan: {pattern: conical, radius: 1 deg, frequency: 1e6 Hz}}", "{jitter: {spectrum: [[1e-6 Hz, 1 urad2/Hz], [1e6 Hz, 1 urad2/Hz]]}}"})
    for (const char* rate : {"1e-6 Hz", "25 Hz"}) EXPECT_EQ(refusal(rate, gimbal), "") << gimbal;
  EXPECT_EQ(refusal("0.001 Hz", "{rate: 10 deg/s}"), "");
  EXPECT_EQ(refusal("25 Hz", "{rate: 10 deg/s}", 2000000), "");
}

// With motion blur a scan that comes round within an exposure asks for so many pictures of it as show it: eight a turn.
TEST(GimbalServo, ScansWithinAnExposureAreSeen) {
  const std::string blur = "motion_blur: true, exposure: 10 ms, ";
  const std::string said = refusal("25 Hz", "{scan: {pattern: conical, radius: 1 deg, frequency: 1 kHz}}", 3, blur);
  EXPECT_NE(said.find("a scan that goes through 10 turns within an exposure with motion_blur; expected 'exposure_parts' of the camera, 80 or more"),
            std::string::npos)
      << said;
  EXPECT_EQ(refusal("25 Hz", "{scan: {pattern: conical, radius: 1 deg, frequency: 1 kHz}}", 3, blur + "exposure_parts: 80, "), "");
  EXPECT_EQ(refusal("25 Hz", "{scan: {pattern: conical, radius: 1 deg, frequency: 1 kHz}}"), "");
  EXPECT_EQ(refusal("25 Hz", "{scan: {pattern: conical, radius: 1 deg, frequency: 40 Hz}}", 3, blur), "");
  for (const char* scan :
       {"{pattern: conical, radius: 1 deg, frequency: 1e6 Hz}", "{pattern: rosette, radius: 1 deg, frequency: 20 Hz, second_frequency: 9e5 Hz}",
        "{pattern: spiral, radius: 1 deg, turns: 3, frequency: 5 kHz}", "{pattern: raster, width: 2 deg, height: 1 deg, lines: 100, line_rate: 1e6 Hz}"})
    EXPECT_NE(refusal("25 Hz", std::string("{scan: ") + scan + "}", 3, blur).find("expected at most 32 in an exposure of 256 parts"), std::string::npos)
        << scan;
}

}  // namespace
}  // namespace pitviper::test
