#pragma once
// Where commands wait that come while a stream runs, from whatever port, until the loop takes them.
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/command.hpp"

namespace pitviper {

struct LiveCommand {
  Command command;               ///< at_s: NaN: from the tick that takes it
  std::int64_t received_ns = 0;  ///< monotonic
  std::uint64_t hostFrame = 0;   ///< 0: none given
};

/// A host that holds the clock lets it go on.
struct Step {
  std::uint64_t ticks = 1;
  std::uint64_t hostFrame = 0;
  std::uint64_t ticket = 0;  ///< whose step it is: told when its frames are out
};

/// What became of what came. Safe from any thread.
class CommandInbox {
 public:
  /// `log`: gets a line the first time that something of a kind is refused; from whatever thread.
  explicit CommandInbox(std::function<void(const std::string&)> log = {}) : log_(std::move(log)) {}

  /// False where too many wait: it is counted and gone.
  bool put(LiveCommand command);
  /// False where too many wait: it is counted and gone.
  bool step(const Step& step);
  void setRunning(bool runs);
  /// The stream is to end after the frame it is at; or after the steps that wait.
  void end();
  void endAfterSteps();
  /// A packet or line that is ignored: counted by its kind ("malformed", "stale"), told once. `says`: what was wrong with this one.
  void refuse(const std::string& kind, const std::string& says);

  std::vector<LiveCommand> take();
  /// Waits for a step; none where the stream is to end or the time is over.
  std::optional<Step> waitForStep(std::int64_t timeout_ns);
  bool isRunning() const;
  bool isEnding() const;
  std::map<std::string, std::uint64_t> counts() const;

 private:
  static constexpr std::size_t kMost = 16384;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::function<void(const std::string&)> log_;
  std::vector<LiveCommand> commands_;
  std::vector<Step> steps_;
  std::map<std::string, std::uint64_t> counts_;
  bool runs_ = true, ends_ = false, endsAfter_ = false;
};

/// A tick that is over: its frames are out, or were dropped.
struct TickDone {
  std::uint64_t sequence = 0, hostFrame = 0;
  int frame = 0;
  double time_s = 0.0;
  std::optional<std::uint64_t> ticket;  ///< of the step that this tick ends
  int dropped = 0;                      ///< frames that were not sent
};

}  // namespace pitviper
