#include "sim/stream/projector/window_projector.hpp"

#include <algorithm>
#include <atomic>
#include <optional>

#include "sim/stream/projector/display_window.hpp"
#include "sim/stream/projector/projector_failure.hpp"
#include "sim/stream/projector/swap_timer.hpp"

namespace pitviper {
namespace {

using Clock = std::chrono::steady_clock;

/// An X server that does not answer by then hangs; its first picture takes a busy machine without a graphics card a second.
constexpr std::chrono::seconds kOpening{20};

}  // namespace

/// What the window's thread, which may be left behind, and its owner both use.
struct WindowProjector::Shared {
  FrameMailbox mailbox;
  std::atomic<bool> stop = false;
  std::atomic<std::uint64_t> replaced = 0;

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool isOpen = false, isOver = false, isPaced = false;
  double rate_hz = 0.0;
  std::optional<ProjectorFailure> failure;
  ProjectorSwap last;
  std::uint64_t shown = 0;

  void opened(const SwapTimer& timer) {
    const std::lock_guard lock(mutex);
    isOpen = true;
    isPaced = timer.isPaced();
    rate_hz = timer.rate_hz();
    changed.notify_all();
  }
  void swapped(Clock::time_point at, const std::optional<std::uint64_t>& sequence, bool isNew) {
    const std::lock_guard lock(mutex);
    last = {last.number + 1, std::chrono::nanoseconds(at.time_since_epoch()).count(), sequence.value_or(0), sequence.has_value()};
    shown += isNew ? 1 : 0;
    changed.notify_all();
  }
  void over(std::optional<ProjectorFailure> why) {
    const std::lock_guard lock(mutex);
    failure = std::move(why);
    isOver = true;
    changed.notify_all();
  }
};

void WindowProjector::run(Shared& shared, const ProjectorOptions& options) {
  try {
    DisplayWindow window(options);
    SwapTimer timer(window.nominalRate_hz(), [&] {
      window.isClosed();
      window.draw();
      window.swap();
    });
    shared.opened(timer);
    ShownFrame frame;
    std::optional<std::uint64_t> sequence;
    auto last = Clock::now();
    while (!shared.stop && !window.isClosed()) {
      const bool isNew = shared.mailbox.take(frame, timer.latestFrame(last));
      if (isNew) {
        window.load(frame.pixels);
        sequence = frame.sequence;
      }
      window.draw();
      timer.wait();
      window.swap();
      last = Clock::now();
      shared.mailbox.beginPeriod();
      shared.swapped(last, sequence, isNew);
    }
  } catch (const ProjectorFailure& failure) {
    return shared.over(failure);
  } catch (const std::exception& problem) {
    return shared.over(ProjectorFailure(problem.what(), "", ""));
  }
  shared.over({});
}

WindowProjector::WindowProjector(const ProjectorOptions& options)
    : table_(codeTable(options.levels)),
      pixels_(static_cast<size_t>(options.width) * static_cast<size_t>(options.height)),
      shared_(std::make_shared<Shared>()),
      thread_([shared = shared_, options] { run(*shared, options); }) {
  std::unique_lock lock(shared_->mutex);
  const bool answered = shared_->changed.wait_for(lock, kOpening, [&] { return shared_->isOpen || shared_->isOver; });
  if (!answered) shared_->stop = true;
  if (!answered) throw ProjectorFailure("the display does not answer", "a running X server", "set DISPLAY to another, or restart this one");
  if (shared_->failure) throw ProjectorFailure(*shared_->failure);
}

WindowProjector::~WindowProjector() {
  shared_->stop = true;
  shared_->mailbox.wake();
}

void WindowProjector::show(std::span<const std::uint16_t> codes, std::uint64_t sequence) {
  if (codes.size() != pixels_) throw std::invalid_argument("a frame of another size");
  if (closed()) return;
  next_.pixels.resize(pixels_);
  std::transform(codes.begin(), codes.end(), next_.pixels.begin(), [table = table_.data()](std::uint16_t code) { return table[code]; });
  next_.sequence = sequence;
  if (shared_->mailbox.put(next_)) ++shared_->replaced;
}

bool WindowProjector::waitSwap(ProjectorSwap& swap, std::int64_t timeout_ns) {
  std::unique_lock lock(shared_->mutex);
  const auto isLater = [&] { return shared_->isOver || shared_->last.number > swap.number; };
  // Added to the time now, the longest would pass its range.
  const auto patience = std::min<std::chrono::nanoseconds>(std::chrono::nanoseconds(timeout_ns), std::chrono::hours(24));
  if (!shared_->changed.wait_for(lock, patience, isLater) || shared_->isOver) return false;
  swap = shared_->last;
  return true;
}

bool WindowProjector::closed() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->isOver;
}

std::string WindowProjector::error() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->failure ? shared_->failure->what() : "";
}

ProjectorCounts WindowProjector::counts() const {
  const std::lock_guard lock(shared_->mutex);
  return {shared_->last.number, shared_->shown, shared_->replaced};
}

double WindowProjector::rate_hz() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->rate_hz;
}

bool WindowProjector::isPaced() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->isPaced;
}

}  // namespace pitviper
