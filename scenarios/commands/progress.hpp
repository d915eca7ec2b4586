#pragma once
// A progress bar with an honest remaining time on a terminal; plain lines, a few in all, into a pipe.
#include <chrono>
#include <string>

namespace pitviper {

class Progress {
 public:
  Progress(std::string what, int total);
  void step();
  void finish();

 private:
  void show(bool last);
  std::string what_;
  int total_, done_ = 0, lastTenth_ = -1;
  bool terminal_;
  std::chrono::steady_clock::time_point start_, first_, shown_;
};

}  // namespace pitviper
