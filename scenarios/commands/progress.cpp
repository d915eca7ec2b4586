#include "scenarios/commands/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace pitviper {
namespace {

/// Less than that is not worth a line.
constexpr double kLong_s = 10.0;

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

Progress::Progress(std::string what, int total)
    : what_(std::move(what)), total_(total), terminal_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()), first_(start_), shown_(start_) {}

void Progress::step() {
  const std::lock_guard lock(mutex_);
  ++done_;
  share_ = 0.0;
  lastQuarter_ = 0;
  const auto now = std::chrono::steady_clock::now();
  if (done_ == 1) first_ = now;  // the first frame compiles programs: it says nothing of the others
  if (terminal_ && (seconds(now - shown_) > 0.1 || done_ == total_)) {
    shown_ = now;
    show(false);
  } else if (!terminal_ && total_ > 1) {
    const int tenth = done_ * 4 / total_;
    if (tenth != lastTenth_ && done_ < total_ && done_ > 1) show(false);
    lastTenth_ = tenth;
    shown_ = now;
  }
}

void Progress::within(double share) {
  const std::lock_guard lock(mutex_);
  share_ = std::clamp(share, 0.0, 1.0);
  const auto now = std::chrono::steady_clock::now();
  if (terminal_) {
    if (seconds(now - shown_) <= 0.1) return;
    shown_ = now;
    show(false);
  } else if (const int quarter = static_cast<int>(share_ * 4.0); quarter > lastQuarter_ && share_ < 1.0 && seconds(now - shown_) > kLong_s) {
    lastQuarter_ = quarter;
    shown_ = now;
    show(false);
  }
}

void Progress::show(bool last) {
  const auto now = std::chrono::steady_clock::now();
  // Before the first step is over its share is all there is to judge by.
  const double after = done_ > 0 ? position() - 1.0 : position(), took = seconds(now - (done_ > 0 ? first_ : start_));
  const double rate = after > 0.0 ? after / std::max(1e-9, took) : 0.0;
  const double left = rate > 0.0 ? std::max(0.0, total_ - position()) / rate : 0.0;
  const std::string part = share_ > 0.0 ? " and " + std::to_string(static_cast<int>(100.0 * share_)) + " % of the next" : "";
  if (terminal_) {
    constexpr int kWidth = 30;
    const int filled = std::min(kWidth, static_cast<int>(kWidth * position() / std::max(1, total_)));
    std::string bar(static_cast<size_t>(filled), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r%s [%s] %d/%d%s  %.*f/s  %.0f s left \033[K", what_.c_str(), bar.c_str(), done_, total_, part.c_str(), rate < 0.1 ? 3 : 1, rate,
                 left);
    if (last) std::fprintf(stderr, "\n");
  } else if (!last) {
    std::fprintf(stderr, "%s: %d%s of %d, %.*f/s, %.0f s left\n", what_.c_str(), done_, part.c_str(), total_, rate < 0.1 ? 3 : 1, rate, left);
  }
}

void Progress::finish() {
  if (terminal_) show(true);
}

}  // namespace pitviper
