#include "sim/gl/first_draws.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "sim/gl/context.hpp"
#include "sim/gl/draw_state.hpp"
#include "sim/gl/driver_cache.hpp"
#include "sim/gl/timing.hpp"

namespace pitviper {
namespace {

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
  bool takeLast(std::size_t& number) {
    const std::scoped_lock lock(mutex_);
    if (begin_ >= end_) return false;
    number = --end_;
    return true;
  }

 private:
  std::mutex mutex_;
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
