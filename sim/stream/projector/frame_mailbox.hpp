#pragma once
// The newest frame, from the thread that makes frames to the one that shows them: neither waits for the other's copying.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "sim/stream/projector/code_table.hpp"

namespace pitviper {

struct ShownFrame {
  std::vector<ShownCode> pixels;  ///< row by row from the top
  std::uint64_t sequence = 0;
};

class FrameMailbox {
 public:
  /// Takes the place of one that nobody took: true. `frame` has memory of an older one afterwards.
  bool put(ShownFrame& frame) {
    const std::lock_guard lock(mutex_);
    std::swap(frame, newest_);
    isNew_ = true;
    arrived_.notify_one();
    return std::exchange(full_, true);
  }
  /// What is here comes from the last period, too late for its swap: take() waits for a newer one. Else a stream that was late once would stay a period behind.
  void beginPeriod() {
    const std::lock_guard lock(mutex_);
    isNew_ = false;
  }
  /// The newest: the first of this period, or what there is then. False: there is none, or somebody woke it.
  bool take(ShownFrame& frame, std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    arrived_.wait_until(lock, until, [this] { return isNew_ || awake_; });
    if (!full_) return false;
    std::swap(frame, newest_);
    full_ = false;
    return true;
  }
  /// For good.
  void wake() {
    const std::lock_guard lock(mutex_);
    awake_ = true;
    arrived_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  ShownFrame newest_;
  bool full_ = false, isNew_ = false, awake_ = false;
};

}  // namespace pitviper
