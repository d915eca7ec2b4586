#include "sim/gl/first_draws.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "sim/gl/context.hpp"
#include "sim/gl/draw_state.hpp"
#include "sim/gl/driver_cache.hpp"
#include "sim/gl/timing.hpp"

namespace pitviper {
namespace {

/// A program that takes longer than this is being compiled; one that the driver finds in its cache takes a tenth to half of it. Until then nobody helps.
constexpr std::chrono::milliseconds kFound{80};
/// Threads beside this one, each of which takes some tens of megabytes while it compiles.
constexpr unsigned kMostBeside = 7;

/// Numbers in rising order to some, in falling order to one: what that one draws next the others have had the longest time to hand over.
class Shares {
 public:
  explicit Shares(std::size_t count) : end_(count) {}
  bool takeFirst(std::size_t& number) {
    const std::scoped_lock lock(mutex_);
    if (begin_ >= end_) return false;
    number = begin_++;
    return true;
  }
  /// Of the one, which has made what it took before.
  bool takeLast(std::size_t& number) {
    const std::scoped_lock lock(mutex_);
    progress_.notify_all();
    if (begin_ >= end_) return false;
    number = --end_;
    return true;
  }
  /// Whether the one is at one for so long; else none is left.
  bool takesLong() {
    std::unique_lock lock(mutex_);
    for (std::size_t seen = end_; begin_ < end_; seen = end_)
      if (!progress_.wait_for(lock, kFound, [&] { return end_ != seen || begin_ >= end_; })) return true;
    return false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable progress_;
  std::size_t begin_ = 0, end_;
};

void drawUnseen(const Program& program, unsigned primitive) {
  program.use();
  const UnseenDraws unseen;
  glDrawArrays(primitive, 0, primitive == GL_POINTS ? 1 : 3);
}

}  // namespace

FirstDraws::FirstDraws() = default;
FirstDraws::~FirstDraws() = default;

void FirstDraws::add(const Program& program, unsigned primitive) {
  if (program.isMade() || std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.program == &program; })) return;
  entries_.push_back({&program, primitive, std::make_unique<const DrawState>()});
}

void FirstDraws::make() {
  const unsigned beside = entries_.empty() ? 0 : std::min({std::thread::hardware_concurrency() - 1, static_cast<unsigned>(entries_.size()) - 1, kMostBeside});
  if (beside == 0 || !isSoftware() || !driverKeepsPrograms()) return entries_.clear();
  const TimedPart part(kProgramsPart);
  const DrawState before;
  Shares shares(entries_.size());
  const SharedContext shared = SharedContext::ofCurrent();
  const auto besides = [&] {
    try {
      if (!shares.takesLong()) return;
      const GlContext context(shared);
      const VertexArray none = makeVertexArray();
      glBindVertexArray(none);
      const Framebuffer framebuffer = makeFramebuffer();
      for (std::size_t k = 0; shares.takeFirst(k);) {
        entries_[k].state->applyElsewhere(framebuffer);
        drawUnseen(*entries_[k].program, entries_[k].primitive);
      }
      glFinish();
    } catch (const GlError&) {
      // What it has not made is made at its first use, by the thread that can say what is wrong.
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned k = 0; k < beside; ++k) threads.emplace_back(besides);
  for (std::size_t k = 0; shares.takeLast(k);) {
    entries_[k].state->apply();
    drawUnseen(*entries_[k].program, entries_[k].primitive);
  }
  threads.clear();
  before.apply();
  entries_.clear();
}

}  // namespace pitviper
