// Parts of a frame's time: each counts by itself, by the name of what it stands in, and only while somebody asks.
#include <gtest/gtest.h>

#include <thread>

#include "sim/gl/timing.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

void wait(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

TEST(Timing, PartsWithinPartsCountByThemselves) {
  needContext();
  { const TimedPart unasked("unasked"); }
  Timing all;
  const auto start = std::chrono::steady_clock::now();
  {
    const TimedPart outer("outer");
    wait(5);
    {
      const TimedPart inner("inner");
      wait(40);
    }
    wait(5);
  }
  wait(20);
  {
    const TimedPart outer("outer");
    wait(5);
  }
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ASSERT_EQ(all.seconds().size(), 2u);
  const double outer = all.seconds().at("outer"), inner = all.seconds().at("outer: inner");
  // Sleeping takes at least what was asked for, however slow the machine.
  EXPECT_GE(outer, 0.015);
  EXPECT_GE(inner, 0.040);
  EXPECT_LE(outer + inner, whole - 0.020) << "what no part holds, and an inner part in its outer one, count for none";
}

TEST(Timing, TheLastOneMadeCollects) {
  needContext();
  Timing before;
  {
    Timing own;
    const TimedPart part("part");
    wait(1);
  }
  EXPECT_TRUE(before.seconds().empty());
  { const TimedPart part("later"); }
  EXPECT_EQ(before.seconds().count("later"), 1u);
}

}  // namespace
}  // namespace pitviper::test
