#pragma once
// From when to when something is in a scene.
#include <limits>

namespace pitviper {

/// Times within a nanosecond are the same: those of frames are sums of steps, which round.
constexpr double kSameTime_s = 1e-9;

/// From its begin on until its end, at which it is no longer there: what takes its place may begin then.
struct Lifetime {
  double begin_s = -std::numeric_limits<double>::infinity(), end_s = std::numeric_limits<double>::infinity();
  bool has(double time_s) const { return time_s >= begin_s - kSameTime_s && time_s < end_s - kSameTime_s; }
  bool isEndless() const { return begin_s == -std::numeric_limits<double>::infinity() && end_s == std::numeric_limits<double>::infinity(); }
};

}  // namespace pitviper
