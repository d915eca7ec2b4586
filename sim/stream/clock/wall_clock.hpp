#pragma once
// The wall clock, which is the stream's business alone.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pitviper {

/// CLOCK_MONOTONIC [ns]: deadlines and durations.
std::int64_t monotonic_ns();
/// The same moment as TAI since 1970 [ns]. Where the system does not know its leap seconds, UTC + 37 s (IERS Bulletin C, since 2017).
std::int64_t taiOf_ns(std::int64_t monotonic_ns);
/// Until a moment of the monotonic clock, also if signals interrupt.
void sleepUntil_ns(std::int64_t monotonic_ns);
/// The same; looks every 50 ms whether it is to end, and is false then.
bool sleepUntil_ns(std::int64_t monotonic_ns, const std::function<bool()>& ends);

/// How the system is to treat the calling thread.
struct ThreadWish {
  int fifoPriority = 0;    ///< of SCHED_FIFO, 1 to 99; 0: as others
  std::vector<int> cores;  ///< that it may run on; empty: any
};
/// What could not be had and why; empty: all was.
std::string askFor(const ThreadWish& wish);

}  // namespace pitviper
