#include "sim/stream/queued_sink.hpp"

namespace pitviper {

QueuedSink::QueuedSink(std::unique_ptr<Sink> sink, std::string name, bool skips, std::size_t length)
    : sink_(std::move(sink)), name_(std::move(name)), skips_(skips), length_(length) {
  thread_ = std::thread([this] { serve(); });
}

QueuedSink::~QueuedSink() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    queue_.clear();
  }
  wake_.notify_all();
  thread_.join();
}

void QueuedSink::take(const std::shared_ptr<const Frame>& frame) {
  std::unique_lock lock(mutex_);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  ++taken_;
  if (queue_.size() >= length_) {
    if (skips_) {
      ++skipped_;
      return;
    }
    room_.wait(lock, [this] { return queue_.size() < length_ || failure_; });
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  queue_.push_back(frame);
  lock.unlock();
  wake_.notify_one();
}

void QueuedSink::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ends_ || !queue_.empty(); });
    if (queue_.empty()) return;
    const auto frame = std::move(queue_.front());
    queue_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr failure;
    try {
      sink_->take(frame);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (failure) {
      failure_ = failure;
      ++skipped_;
    } else {
      ++passed_;
    }
    room_.notify_all();
  }
}

void QueuedSink::finish(const std::function<void(double)>& progress) {
  {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [this] { return (queue_.empty() && !busy_) || failure_; });
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  sink_->finish(progress);
}

std::vector<SinkCounts> QueuedSink::counts() const {
  const std::lock_guard lock(mutex_);
  std::vector<SinkCounts> own = sink_->counts();
  if (own.empty()) own.push_back({name_, taken_, passed_, 0, {}});
  own.front().taken = taken_;
  own.front().skipped += skipped_;
  return own;
}

}  // namespace pitviper
