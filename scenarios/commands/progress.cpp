#include "scenarios/commands/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace pitviper {
namespace {
double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }
}  // namespace

Progress::Progress(std::string what, int total)
    : what_(std::move(what)), total_(total), terminal_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()), first_(start_), shown_(start_) {}

void Progress::step() {
  ++done_;
  const auto now = std::chrono::steady_clock::now();
  if (done_ == 1) first_ = now;  // the first frame compiles programs: it says nothing of the others
  if (terminal_ && (seconds(now - shown_) > 0.1 || done_ == total_)) {
    shown_ = now;
    show(false);
  } else if (!terminal_ && total_ > 1) {
    const int tenth = done_ * 4 / total_;
    if (tenth != lastTenth_ && done_ < total_ && done_ > 1) show(false);
    lastTenth_ = tenth;
  }
}

void Progress::show(bool last) {
  const auto now = std::chrono::steady_clock::now();
  const double rate = done_ > 1 ? (done_ - 1) / std::max(1e-9, seconds(now - first_)) : 0.0;
  const double left = rate > 0.0 ? (total_ - done_) / rate : 0.0;
  if (terminal_) {
    constexpr int kWidth = 30;
    const int filled = kWidth * done_ / std::max(1, total_);
    std::string bar(static_cast<size_t>(filled), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r%s [%s] %d/%d  %.1f/s  %.0f s left \033[K", what_.c_str(), bar.c_str(), done_, total_, rate, left);
    if (last) std::fprintf(stderr, "\n");
  } else if (!last) {
    std::fprintf(stderr, "%s: %d of %d, %.1f/s, %.0f s left\n", what_.c_str(), done_, total_, rate, left);
  }
}

void Progress::finish() {
  if (terminal_) show(true);
}

}  // namespace pitviper
