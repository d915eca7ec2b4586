#include "scenarios/commands/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// How often a bar is drawn anew [s].
constexpr double kBar_s = 0.2;

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// "37 s", "12 min", "3.4 h": no more digits than are known.
std::string duration(double s) { return s < 100.0 ? print("%.0f s", s) : s < 6000.0 ? print("%.0f min", s / 60.0) : print("%.1f h", s / 3600.0); }

double stepsASecond(const ProgressState& s) {
  // Before the first step is over its share is all there is to judge by.
  const double done = s.done > 0 ? s.done + s.share - 1.0 : s.share, took = s.done > 0 ? s.sinceFirst_s : s.elapsed_s;
  return done > 0.0 && took > 0.0 ? done / took : 0.0;
}

}  // namespace

double secondsLeft(const ProgressState& s) {
  const double rate = stepsASecond(s);
  return rate > 0.0 ? std::max(0.0, s.total - s.done - s.share) / rate : -1.0;
}

std::string progressText(const ProgressState& s) {
  if (!s.phase.empty()) {
    std::string text = s.phase;
    if (s.phaseShare > 0.0) text += print(", %.0f %%", 100.0 * s.phaseShare);
    return text + ", " + duration(s.elapsed_s) + " so far";
  }
  if (s.total <= 0)
    return std::to_string(s.done) + (stepsASecond(s) > 0.0 ? ", " + print("%.1f/s", stepsASecond(s)) : "") + ", " + duration(s.elapsed_s) + " so far";
  std::string text = std::to_string(s.done) + " of " + std::to_string(s.total);
  if (s.share > 0.0) text += " and " + print("%.0f %%", 100.0 * s.share) + " of the next";
  const double rate = stepsASecond(s), left = secondsLeft(s);
  if (left < 0.0) return text + ", " + duration(s.elapsed_s) + " so far";
  return text + ", " + print(rate < 0.1 ? "%.3f/s" : "%.1f/s", rate) + ", " + duration(left) + " left";
}

double ProgressPace::next_s(double elapsed_s) const { return std::max(first_s, elapsed_s + std::min(elapsed_s, most_s)); }

Progress::Progress(std::string what, int total, ProgressPace pace, std::function<void(const std::string&)> line)
    : what_(std::move(what)),
      pace_(pace),
      line_(std::move(line)),
      start_(Clock::now()),
      first_(start_),
      terminal_(!line_ && isatty(STDERR_FILENO) != 0),
      watcher_([this] { watch(); }) {
  const std::lock_guard lock(mutex_);
  state_.total = total;
}

Progress::~Progress() { finish(); }

void Progress::phase(const std::string& name, double share) {
  const std::lock_guard lock(mutex_);
  state_.phase = name;
  state_.phaseShare = std::clamp(share, 0.0, 1.0);
}

void Progress::step() {
  const std::lock_guard lock(mutex_);
  if (++state_.done == 1) first_ = Clock::now();
  state_.share = 0.0;
  state_.phaseShare = 0.0;
  state_.phase.clear();
}

void Progress::within(double share) {
  const std::lock_guard lock(mutex_);
  state_.share = std::clamp(share, 0.0, 1.0);
  state_.phaseShare = 0.0;
  state_.phase.clear();
}

double Progress::elapsed_s() const { return seconds(Clock::now() - start_); }

ProgressState Progress::now() const {
  ProgressState s = state_;
  const auto at = Clock::now();
  s.elapsed_s = seconds(at - start_);
  s.sinceFirst_s = s.done > 0 ? seconds(at - first_) : 0.0;
  return s;
}

void Progress::watch() {
  std::unique_lock lock(mutex_);
  double next_s = terminal_ ? kBar_s : pace_.first_s;
  while (!finished_) {
    wake_.wait_until(lock, start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(next_s)));
    const ProgressState s = now();
    if (finished_ || s.elapsed_s < next_s) continue;
    if (terminal_) {
      drawBar(false);
      next_s = s.elapsed_s + kBar_s;
      continue;
    }
    next_s = pace_.next_s(s.elapsed_s);
    const std::string text = what_ + ": " + progressText(s);
    if (line_) line_(text);
    else std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void Progress::drawBar(bool last) {
  constexpr int kWidth = 30;
  const ProgressState s = now();
  const double share = s.phaseShare > 0.0 ? s.phaseShare : (s.done + s.share) / std::max(1, s.total);
  const int filled = std::clamp(static_cast<int>(kWidth * share), 0, kWidth);
  std::string bar(static_cast<size_t>(filled), '#');
  bar.resize(kWidth, '.');
  std::fprintf(stderr, "\r%s [%s] %s\033[K%s", what_.c_str(), bar.c_str(), progressText(s).c_str(), last ? "\n" : "");
}

void Progress::end(bool keepsBar) {
  {
    const std::lock_guard lock(mutex_);
    if (finished_) return;
    finished_ = true;
    if (terminal_ && keepsBar) drawBar(true);
    else if (terminal_) std::fprintf(stderr, "\r\033[K");
  }
  wake_.notify_all();
  watcher_.join();
}

}  // namespace pitviper
