#include "sim/gl/timing.hpp"

#include <epoxy/gl.h>

#include <ctime>

namespace pitviper {
namespace {

thread_local Timing* current = nullptr;

}  // namespace

double workSoFar_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Timing::Timing() : last_(std::chrono::steady_clock::now()), lastWork_s_(workSoFar_s()), before_(current) { current = this; }
Timing::~Timing() { end(); }

void Timing::end() {
  if (current == this) current = before_;
}

void Timing::charge() {
  glFinish();
  const auto now = std::chrono::steady_clock::now();
  const double work_s = workSoFar_s();
  if (!open_.empty()) {
    seconds_[open_.back()] += std::chrono::duration<double>(now - last_).count();
    workSeconds_[open_.back()] += work_s - lastWork_s_;
  }
  last_ = now;
  lastWork_s_ = work_s;
}

TimedPart::TimedPart(const char* name) : timing_(current) {
  if (!timing_) return;
  timing_->charge();
  timing_->open_.push_back(timing_->open_.empty() ? name : timing_->open_.back() + ": " + name);
}

TimedPart::~TimedPart() {
  if (!timing_) return;
  timing_->charge();
  timing_->open_.pop_back();
}

}  // namespace pitviper
