#pragma once
// Between drawing and sinks: when a frame leaves, and what leaves where there is none.
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <thread>

#include "sim/run/stream_account.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/command_inbox.hpp"

namespace pitviper {

/// What becomes of a frame that is not there when it is due: it is sent as soon as it is; it is not sent; the picture before is sent again in its place.
enum class LatePolicy { Send, Drop, Repeat };

/// A frame of a camera, drawn; or a tick that was not drawn (no frame).
struct PacedFrame {
  std::size_t camera = 0;
  std::uint64_t tick = 0;
  std::shared_ptr<Frame> frame;
  std::int64_t tick_ns = 0, due_ns = 0, begun_ns = 0, made_ns = 0;  ///< monotonic; due 0: never late
  std::shared_ptr<TickDone> done;                                   ///< shared by the frames of a tick
  bool isLast = false;                                              ///< of its tick
};

class FramePacer {
 public:
  using HandOver = std::function<void(const std::shared_ptr<const Frame>&)>;
  using TickOver = std::function<void(const TickDone&)>;
  /// `holds`: no frame leaves before it is due. Frames are handed over by a thread of its own where it holds or repeats, else within put().
  /// `thread`: of its own thread, as far as the system lets it. `tickOver`: called when the last frame of a tick has left, or was dropped.
  FramePacer(LatePolicy policy, bool holds, StreamAccount& account, HandOver handOver, TickOver tickOver = {}, const ThreadWish& thread = {});
  ~FramePacer();
  /// In the order of ticks, and of cameras within one.
  void put(PacedFrame frame);
  /// That a frame is to come: from now on it may be repeated in its place.
  void expect(const PacedFrame& frame);
  /// All that was put has left. Throws what the sinks threw.
  void finish();

 private:
  void serve();
  void leave(PacedFrame& frame);
  void repeat(const PacedFrame& missing);
  void drop(const PacedFrame& frame);
  void tell(const PacedFrame& frame);
  LatePolicy policy_;
  bool holds_;
  StreamAccount& account_;
  HandOver handOver_;
  TickOver tickOver_;
  std::mutex mutex_;
  std::condition_variable wake_, emptied_;
  std::deque<PacedFrame> expected_;                 ///< what comes, in order, not there yet or not due
  std::vector<std::shared_ptr<const Frame>> last_;  ///< the newest of each camera
  std::exception_ptr failure_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace pitviper
