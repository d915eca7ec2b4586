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

/// A line a part, the longest first, in ms a frame and of what a frame takes, of all frames but the first; preparation and the first frame by themselves
/// [s]. `parts`: of runFrames(); `files_s`: what writing took beside them.
std::string timingText(const std::map<std::string, double>& parts, double files_s, int frames);

}  // namespace pitviper
