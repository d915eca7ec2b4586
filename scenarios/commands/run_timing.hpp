#pragma once
// Where the time of a run went, for `run --timing`.
#include <chrono>
#include <map>
#include <string>

namespace pitviper {

/// Time that another thread takes for something, added up [s].
class Stopwatch {
 public:
  template <class Work>
  void time(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  double seconds() const { return seconds_; }

 private:
  double seconds_ = 0.0;
};

/// A line a part, the longest first, in ms a frame and of what a frame takes; preparation by itself [s]. `parts`: of sim/gl/timing.hpp, all frames of a run;
/// `files_s`: what writing took beside them.
std::string timingText(const std::map<std::string, double>& parts, double files_s, int frames);

/// The part that is no frame's.
inline constexpr const char* kPreparing = "preparing";

}  // namespace pitviper
