#include "sim/gl/timing.hpp"

#include <epoxy/gl.h>

namespace pitviper {
namespace {

thread_local Timing* current = nullptr;

}  // namespace

Timing::Timing() : last_(std::chrono::steady_clock::now()), before_(current) { current = this; }
Timing::~Timing() { current = before_; }

void Timing::charge() {
  glFinish();
  const auto now = std::chrono::steady_clock::now();
  if (!open_.empty()) seconds_[open_.back()] += std::chrono::duration<double>(now - last_).count();
  last_ = now;
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
