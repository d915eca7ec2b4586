#pragma once
// When swaps come, and how they are held apart where the display does not.
#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace pitviper {

class SwapTimer {
 public:
  using Clock = std::chrono::steady_clock;

  /// Swaps of the beginning that are measured, and those before, in which drivers and compositors settle.
  static constexpr int kMeasured = 24, kSettling = 6;

  /// Swaps the display kSettling + kMeasured times. `nominal_hz`: the monitor's.
  template <class Swap>
  SwapTimer(double nominal_hz, Swap swap) {
    std::vector<double> periods_s;
    auto last = Clock::now();
    for (int i = 0; i < kSettling + kMeasured; ++i) {
      swap();
      const auto now = Clock::now();
      if (i >= kSettling) periods_s.push_back(std::chrono::duration<double>(now - last).count());
      last = now;
    }
    // The median: a swap or two are late where the machine is busy.
    std::nth_element(periods_s.begin(), periods_s.begin() + kMeasured / 2, periods_s.end());
    const double median_s = periods_s[kMeasured / 2];
    isPaced_ = median_s * nominal_hz < kHeld;
    period_s_ = isPaced_ ? 1.0 / nominal_hz : median_s;
    next_ = last;
  }

  bool isPaced() const { return isPaced_; }
  double rate_hz() const { return 1.0 / period_s_; }
  /// Until when a frame may come and be shown by the next swap: half of a period is left for drawing it, so that a blanking is not missed.
  Clock::time_point latestFrame(Clock::time_point lastSwap) const { return lastSwap + toDuration(0.5 * period_s_); }
  /// Before a swap. Where the display holds them, it does not wait.
  void wait() {
    if (!isPaced_) return;
    next_ += toDuration(period_s_);
    if (const auto now = Clock::now(); next_ < now - toDuration(period_s_)) next_ = now;  // too late to catch up
    std::this_thread::sleep_until(next_);
  }

 private:
  /// Part of the nominal period below which no display holds swaps: rates above are none of a monitor that names the nominal one.
  static constexpr double kHeld = 0.67;

  static Clock::duration toDuration(double s) { return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s)); }

  double period_s_ = 0.0;
  bool isPaced_ = false;
  Clock::time_point next_;
};

}  // namespace pitviper
