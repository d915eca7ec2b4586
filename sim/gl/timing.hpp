#pragma once
// Where time goes, part by part, while somebody asks. Nobody asking, a part costs nothing.
#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace pitviper {

/// Collects the parts of this thread while it lives; the one made last. Each part then waits for the GPU at both its ends, so that what was begun
/// counts where it was begun. A part within another counts by itself, as "outer: inner".
class Timing {
 public:
  Timing();
  ~Timing();
  Timing(const Timing&) = delete;
  Timing& operator=(const Timing&) = delete;
  /// [s]
  const std::map<std::string, double>& seconds() const { return seconds_; }
  /// The same of what all threads of this process worked meanwhile: processor seconds.
  const std::map<std::string, double>& workSeconds() const { return workSeconds_; }
  /// Parts that begin from now on count no more, and wait for nothing; those that are open still do.
  void end();

 private:
  friend class TimedPart;
  void charge();
  std::map<std::string, double> seconds_, workSeconds_;
  std::vector<std::string> open_;
  std::chrono::steady_clock::time_point last_;
  double lastWork_s_;
  Timing* before_;
};

/// Processor seconds that this process has used so far, all its threads together.
double workSoFar_s();

/// A part of a frame's work, from here to the end of its scope.
class TimedPart {
 public:
  explicit TimedPart(const char* name);
  ~TimedPart();
  TimedPart(const TimedPart&) = delete;
  TimedPart& operator=(const TimedPart&) = delete;

 private:
  Timing* timing_;
};

}  // namespace pitviper
