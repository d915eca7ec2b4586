#pragma once
// A progress bar with an honest remaining time on a terminal; plain lines, a few in all, into a pipe.
#include <chrono>
#include <mutex>
#include <string>

namespace pitviper {

class Progress {
 public:
  Progress(std::string what, int total);
  /// One more is done. Steps may come from another thread than shares.
  void step();
  /// How much of the next step is done, for steps that take long: 0 to 1. Into a pipe: a line in ten seconds at most, at quarters.
  void within(double share);
  void finish();

 private:
  void show(bool last);
  double position() const { return done_ + share_; }
  std::mutex mutex_;
  std::string what_;
  int total_, done_ = 0, lastTenth_ = -1, lastQuarter_ = 0;
  double share_ = 0.0;
  bool terminal_;
  std::chrono::steady_clock::time_point start_, first_, shown_;
};

}  // namespace pitviper
