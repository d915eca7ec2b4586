#pragma once
// Where the time of a run went, for `run --timing`.
#include <chrono>
#include <map>
#include <string>

#include "sim/gl/objects.hpp"

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

/// Which of "planning", "tables" (all other preparing), "programs" and "first_frame" a part belongs to that no later frame takes; empty: to frames.
std::string stageOf(const std::string& part);

/// A line a part, the longest first, in ms a frame and of what a frame takes, of all frames but the first; preparation and the first frame by themselves,
/// stage by stage [s]. `parts`: of runFrames(); `programs`: made meanwhile; `files_s`: what writing took beside them.
std::string timingText(const std::map<std::string, double>& parts, const ProgramCount& programs, double files_s, int frames);

}  // namespace pitviper
