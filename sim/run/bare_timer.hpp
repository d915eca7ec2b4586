#pragma once
// A loop that does nothing but wake at a stream's rate: what the machine itself is late by, in the same minute.
#include <atomic>
#include <cstdint>
#include <thread>

#include "sim/stream/clock/durations.hpp"

namespace pitviper {

class BareTimer {
 public:
  BareTimer(std::int64_t first_ns, std::int64_t period_ns);
  ~BareTimer() { end(); }
  void end();
  /// After end(): how late it woke, and how often by more than a tenth of a period.
  const Durations& lateness() const { return lateness_; }
  std::uint64_t late() const { return late_; }

 private:
  std::atomic<bool> ends_{false};
  Durations lateness_;
  std::uint64_t late_ = 0;
  std::thread thread_;
};

}  // namespace pitviper
