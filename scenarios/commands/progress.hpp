#pragma once
// How far a long command is: a bar with an honest remaining time on a terminal; plain lines at growing intervals into a pipe or a file.
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace pitviper {

/// What there is to tell at one moment.
struct ProgressState {
  std::string phase;        ///< what goes on before and between steps ("planning seeker"); empty: nothing but steps
  double phaseShare = 0.0;  ///< of it that is done; 0: not known
  int done = 0, total = 0;
  double share = 0.0;         ///< of the next step that is done
  double elapsed_s = 0.0;     ///< since the beginning
  double sinceFirst_s = 0.0;  ///< since the first step was done: it compiles programs and says nothing of the others
};

/// Seconds left, by the steps after the first; before it is done, by its share; negative where there is nothing to judge by.
double secondsLeft(const ProgressState& state);
/// "12 of 90, 2.1/s, 37 s left", "planning seeker, 40 %, 5 s so far".
std::string progressText(const ProgressState& state);

/// When plain lines come: the first after `first_s`, each next after as long again as all before it, at most `most_s` apart.
struct ProgressPace {
  double first_s = 3.0, most_s = 300.0;
  double next_s(double elapsed_s) const;
};

class Progress {
 public:
  /// Off a terminal lines go to `line` (stderr unless given).
  /// `total` 0: nobody knows.
  Progress(std::string what, int total, ProgressPace pace = {}, std::function<void(const std::string&)> line = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What goes on that is no step, and how much of it is done (0 to 1; 0: not known). Ends with the next step, or with an empty name.
  void phase(const std::string& name, double share = 0.0);
  /// One more is done. Everything here may be called from any thread.
  void step();
  /// How much of the next step is done, for steps that take long: 0 to 1.
  void within(double share);
  /// Says no more.
  void finish() { end(true); }
  /// The same, and takes its bar off the terminal: where what comes next says all.
  void withdraw() { end(false); }
  double elapsed_s() const;

 private:
  using Clock = std::chrono::steady_clock;
  void end(bool keepsBar);
  void watch();
  ProgressState now() const;
  void drawBar(bool last);

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::string what_;
  ProgressPace pace_;
  std::function<void(const std::string&)> line_;
  ProgressState state_;
  Clock::time_point start_, first_;
  bool terminal_, finished_ = false;
  std::thread watcher_;  ///< tells of time going by although nothing is reported: planning and compiling take long
};

}  // namespace pitviper
