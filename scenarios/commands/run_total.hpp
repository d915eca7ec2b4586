#pragma once
// What a run sums up at its end.
#include <map>
#include <string>

#include "sim/run/run.hpp"

namespace pitviper {

class RunTotal {
 public:
  /// Takes what a frame says of itself.
  void add(const Frame& frame);
  /// "12.3 s, 7.3 frames a second".
  static std::string pace(int frames, double seconds);
  /// A line for each camera: "seeker: planned to 1 %; expected error at most mw 0.65 %, lw 0.28 %".
  std::string expected() const;

 private:
  struct Seen {
    std::string mode;
    double accuracy = 0.0;
    int parts = 1;  ///< of an exposure, the most
    double motion_px = 0.0, partError = 0.0, streakError = 0.0;
    std::map<std::string, double> error;  ///< by channel, the largest
    int frames = 0, drafts = 0;
    double draftError = 0.0;  ///< the largest of any channel
    struct Full {
      int frames = 0;
      double most = 0.0;  ///< share of a frame's pixels
    };
    std::map<std::string, Full> full;  ///< by channel
  };
  std::map<std::string, Seen> cameras_;
};

/// A line a camera that was audited.
std::string auditText(const RunReport& report);

}  // namespace pitviper
