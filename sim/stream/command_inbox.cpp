#include "sim/stream/command_inbox.hpp"

#include <chrono>
#include <utility>

namespace pitviper {

bool CommandInbox::put(LiveCommand command) {
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() < kMost) {
      commands_.push_back(std::move(command));
      ++counts_["commands"];
      return true;
    }
  }
  refuse("too many at once", "more than " + std::to_string(kMost) + " commands between two frames");
  return false;
}

bool CommandInbox::step(const Step& step) {
  {
    const std::lock_guard lock(mutex_);
    if (steps_.size() < kMost) {
      steps_.push_back(step);
      ++counts_["steps"];
      wake_.notify_one();
      return true;
    }
  }
  refuse("too many at once", "more than " + std::to_string(kMost) + " steps wait");
  return false;
}

void CommandInbox::setRunning(bool runs) {
  {
    const std::lock_guard lock(mutex_);
    runs_ = runs;
  }
  wake_.notify_one();
}

void CommandInbox::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
}

void CommandInbox::refuse(const std::string& kind, const std::string& says) {
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    first = ++counts_[kind] == 1;
  }
  if (first && log_) log_("commands: " + kind + ": " + says + " (others of the kind are only counted)");
}

void CommandInbox::endAfterSteps() {
  {
    const std::lock_guard lock(mutex_);
    endsAfter_ = true;
  }
  wake_.notify_all();
}

std::vector<LiveCommand> CommandInbox::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(commands_, {});
}

std::optional<Step> CommandInbox::waitForStep(std::int64_t timeout_ns) {
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [this] { return ends_ || endsAfter_ || !steps_.empty(); });
  if (ends_ || steps_.empty()) return std::nullopt;
  const Step first = steps_.front();
  steps_.erase(steps_.begin());
  return first;
}

bool CommandInbox::isRunning() const {
  const std::lock_guard lock(mutex_);
  return runs_;
}

bool CommandInbox::isEnding() const {
  const std::lock_guard lock(mutex_);
  return ends_ || (endsAfter_ && steps_.empty());
}

std::map<std::string, std::uint64_t> CommandInbox::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace pitviper
