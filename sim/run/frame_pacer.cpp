#include "sim/run/frame_pacer.hpp"

#include <algorithm>
#include <chrono>

#include "sim/stream/clock/wall_clock.hpp"

namespace pitviper {
namespace {

/// Of std::chrono::steady_clock, which is the monotonic one here.
std::chrono::steady_clock::time_point momentOf(std::int64_t monotonic) { return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(monotonic)); }

}  // namespace

FramePacer::FramePacer(LatePolicy policy, bool holds, StreamAccount& account, HandOver handOver, TickOver tickOver, const ThreadWish& thread)
    : policy_(policy), holds_(holds), account_(account), handOver_(std::move(handOver)), tickOver_(std::move(tickOver)), last_(account.cameras()) {
  if (holds_ || policy_ == LatePolicy::Repeat)
    thread_ = std::thread([this, thread] {
      askFor(thread);  // what is refused is refused to the one that draws too, which tells it
      serve();
    });
}

FramePacer::~FramePacer() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    expected_.clear();
  }
  wake_.notify_all();
  thread_.join();
}

void FramePacer::expect(const PacedFrame& frame) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    expected_.push_back(frame);
  }
  wake_.notify_all();
}

void FramePacer::put(PacedFrame p) {
  if (!thread_.joinable()) {
    if (!p.frame) drop(p);
    else leave(p);
    tell(p);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    const auto own = std::find_if(expected_.begin(), expected_.end(), [&](const PacedFrame& e) { return e.camera == p.camera && e.tick == p.tick; });
    if (own != expected_.end()) {
      *own = std::move(p);
      if (!own->frame) own->begun_ns = -1;  // it will not come
    } else if (p.frame) {
      last_[p.camera] = p.frame;  // something else has been sent in its place: it is what the next repetition shows
    }
  }
  wake_.notify_all();
}

void FramePacer::drop(const PacedFrame& p) {
  account_.dropped(p.camera);
  if (p.done) ++p.done->dropped;
}

void FramePacer::tell(const PacedFrame& p) {
  if (p.isLast && p.done && tickOver_) tickOver_(*p.done);
}

void FramePacer::leave(PacedFrame& p) {
  const std::int64_t now = monotonic_ns();
  const bool late = p.due_ns > 0 && !holds_ && now > p.due_ns;
  // One that is held leaves as its time comes: it is late where it was not there by then.
  const bool lateHeld = p.due_ns > 0 && holds_ && p.made_ns > p.due_ns;
  if ((late || lateHeld) && policy_ == LatePolicy::Drop) {
    drop(p);
    return;
  }
  account_.sent(p.camera, *p.frame->stamp, {p.tick_ns, p.begun_ns, p.made_ns, now, late || lateHeld, false});
  if (late || lateHeld) p.frame->attributes.push_back({"pitviper.stream.late_s", 1e-9 * static_cast<double>(now - p.due_ns)});
  if (thread_.joinable()) {
    const std::lock_guard lock(mutex_);
    last_[p.camera] = p.frame;
  }
  handOver_(p.frame);
}

void FramePacer::repeat(const PacedFrame& missing) {
  std::shared_ptr<const Frame> before;
  {
    const std::lock_guard lock(mutex_);
    before = last_[missing.camera];
  }
  if (!before) {
    drop(missing);
    return;
  }
  auto again = std::make_shared<Frame>(*before);
  again->stamp->sequence = missing.tick;
  again->attributes.push_back({"pitviper.stream.repeated_as", std::to_string(missing.tick)});
  again->stamp->due_tai_ns = taiOf_ns(missing.due_ns);
  const std::int64_t now = monotonic_ns();
  account_.sent(missing.camera, *again->stamp, {missing.tick_ns, now, now, now, false, true});
  handOver_(again);
}

void FramePacer::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return ends_ || !expected_.empty(); });
    if (expected_.empty()) return;
    const std::int64_t due = expected_.front().due_ns;
    const auto isThere = [this] { return expected_.empty() || expected_.front().frame || expected_.front().begun_ns < 0; };
    if (policy_ == LatePolicy::Send || due == 0) wake_.wait(lock, [&] { return ends_ || isThere(); });
    else wake_.wait_until(lock, momentOf(due), [&] { return ends_ || isThere(); });
    if (expected_.empty()) continue;
    PacedFrame next = expected_.front();
    lock.unlock();
    try {
      if (next.frame) {
        if (holds_ && due > 0) sleepUntil_ns(due);
        leave(next);
      } else if (policy_ == LatePolicy::Repeat) {
        sleepUntil_ns(due);
        repeat(next);
      } else {
        drop(next);
      }
      tell(next);
    } catch (...) {
      const std::lock_guard again(mutex_);
      failure_ = std::current_exception();
    }
    lock.lock();
    if (!expected_.empty()) expected_.pop_front();
    emptied_.notify_all();
  }
}

void FramePacer::finish() {
  std::unique_lock lock(mutex_);
  if (thread_.joinable()) emptied_.wait(lock, [this] { return expected_.empty() || failure_; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace pitviper
