#pragma once
// The loop of a stream: one clock, commands as late as they can be taken, frames out as they are due.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/run/frame_pacer.hpp"
#include "sim/run/late_cause.hpp"
#include "sim/run/run.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/command_inbox.hpp"
#include "sim/stream/command_port.hpp"

namespace pitviper {

enum class StreamClock {
  RealTime,  ///< tick n begins at T0 + n periods of the monotonic clock
  Lockstep,  ///< where a host says so
  Free       ///< as soon as the one before is out
};

/// What is to be streamed, and how. A tick is a step of the scenario's time: frame `firstFrame` + n is that of tick n.
struct StreamWish {
  StreamClock clock = StreamClock::RealTime;
  int firstFrame = 0;
  std::uint64_t ticks = 0;    ///< 0: until it is told to end
  std::int64_t delay_ns = 0;  ///< of real time: a frame is due so long after its tick began; 0: a period
  bool holds = false;         ///< and leaves then, not before: its delay is constant
  LatePolicy late = LatePolicy::Send;
  ThreadWish thread;    ///< of the one that draws
  bool drafts = false;  ///< begins with drafts (kDraft) while plans are made beside, and goes over between two ticks
  std::function<void(const Camera& camera, const std::string& lines)> poses;  ///< takes each tick's lines of the record of what points a camera; or empty
  /// A clock from outside in real time's place: waits for a tick, and says when it began; none where it has stopped. Its period is about the scenario's.
  std::function<std::optional<std::int64_t>(std::uint64_t tick)> outsideClock;
};

struct RungUse {
  std::string camera;
  double accuracy = 0.0;
  std::uint64_t frames = 0;
};

struct StreamReport {
  std::uint64_t ticks = 0;                   ///< of the clock, drawn or not
  std::int64_t period_ns = 0, delay_ns = 0;  ///< 0: not of real time
  std::vector<CameraAccount> cameras;
  Durations start;   ///< how late ticks begin
  Durations answer;  ///< lockstep: from a step's arrival to its frames being out, less drawing
  Durations bareTimer;
  std::uint64_t bareTimerLate = 0;
  std::vector<RungUse> rungs;  ///< of cameras with more than one
  std::uint64_t turns = 0;     ///< of the dial
  std::string refused;         ///< of the thread's wishes
  std::array<std::uint64_t, kLateCauses> causes{};  ///< of frames that were not there when they were due
  std::uint64_t drafts = 0;    ///< ticks of which a camera was drawn by a draft
  std::string whyDrafts;       ///< why all were, where the driver could not make what was asked for
  double seconds = 0.0;
  std::int64_t memoryBefore_kB = 0, memoryAfter_kB = 0;  ///< resident: after a tenth of the ticks, or 100; at the end
  std::uint64_t unaccounted() const;                     ///< ticks of cameras that became nothing: never, or the program is wrong
};

/// Draws until the ticks are done, `inbox` says to end, or a sink throws. `sinks`: of those that wait nobody (Sink::neverWaits) or have a queue. The
/// simulation's own audits are not made. `ready`: called when all plans and programs are there, before the first tick.
StreamReport streamFrames(const Simulation& simulation, const ShaderLibrary& library, const StreamWish& wish, CommandInbox& inbox,
                          const std::vector<Sink*>& sinks, const std::vector<CommandPort*>& ports, const RunProgress& progress = {},
                          const std::function<void()>& ready = {}, const std::function<void(std::uint64_t tick)>& ticked = {});

}  // namespace pitviper
