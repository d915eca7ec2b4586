// Why ticks of a stream are late: each cause alone, and what is read of a process that waits.
#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <thread>

#include "sim/run/late_cause.hpp"
#include "sim/stream/clock/wall_clock.hpp"

namespace pitviper {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Ticks of 10 ms: some on time, then one that is late by 8 ms.
struct Watched {
  LateCauses causes;
  ProcessUse use;
  std::int64_t begins_ns = 0;
  Watched() {
    for (int k = 0; k < 50; ++k) {
      // What is usual: half a millisecond of waiting, 200 faults.
      use.waited_ns += kMs / 2, use.minorFaults += 200;
      EXPECT_EQ(causes.look(tick(6)), nullptr);
    }
  }
  LateCauses::Tick tick(std::int64_t made_ms) {
    begins_ns += 10 * kMs;
    return {begins_ns, begins_ns + kMs / 10, begins_ns + 10 * kMs, begins_ns + made_ms * kMs, 0, false, use};
  }
  /// Of a late tick that also has what is usual.
  LateCauses::Tick late() {
    use.waited_ns += kMs / 2, use.minorFaults += 200;
    return tick(18);
  }
};

TEST(LateCause, EachAlone) {
  const auto found = [](auto change) {
    Watched w;
    LateCauses::Tick t = w.late();
    change(t);
    const LateCause* cause = w.causes.look(t);
    EXPECT_NE(cause, nullptr);
    std::uint64_t count = 0;
    for (std::uint64_t c : w.causes.counts()) count += c;
    EXPECT_EQ(count, 1u);
    return cause ? *cause : LateCause::Picture;
  };
  EXPECT_EQ(found([](LateCauses::Tick&) {}), LateCause::Picture);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.handing_ns = 5 * kMs; }), LateCause::Sinks);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.plansBeside = true; }), LateCause::Planner);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.use.programs += 1; }), LateCause::Compiler);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.use.minorFaults += 5000; }), LateCause::PageFaults);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.use.majorFaults += 5; }), LateCause::PageFaults);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.use.waited_ns += 5 * kMs; }), LateCause::Processor);
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.begun_ns = t.begins_ns + 7 * kMs; }), LateCause::Before);
  // Less than half of what it is late by, each: none of them.
  EXPECT_EQ(found([](LateCauses::Tick& t) { t.handing_ns = 3 * kMs, t.use.minorFaults += 3000, t.use.waited_ns += 3 * kMs; }), LateCause::Picture);
}

TEST(LateCause, ThreadsThatWaitForAProcessor) {
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  CPU_ZERO(&one);
  for (int c = 0; c < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++c)
    if (CPU_ISSET(c, &before)) CPU_SET(c, &one);
  ProcessWatch watch;
  std::atomic<bool> ends = false;
  const auto busy = [&] {
    sched_setaffinity(0, sizeof one, &one);
    while (!ends) {
    }
  };
  // Two that want the same processor: over 200 ms one of them waits half of it.
  std::thread a(busy), b(busy);
  sleepUntil_ns(monotonic_ns() + 20 * kMs);
  const ProcessUse from = watch.read();
  sleepUntil_ns(monotonic_ns() + 200 * kMs);
  const ProcessUse to = watch.read();
  ends = true;
  a.join(), b.join();
  EXPECT_GT(to.waited_ns - from.waited_ns, 20 * kMs);
  EXPECT_LT(to.waited_ns - from.waited_ns, monotonic_ns());
}

}  // namespace
}  // namespace pitviper
