#pragma once
// What became of each frame of a stream, and when: every tick of every camera ends as exactly one of four.
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/stream/clock/durations.hpp"

namespace pitviper {

struct CameraAccount {
  std::string camera;
  std::uint64_t onTime = 0, late = 0, dropped = 0, repeated = 0;
  std::uint64_t outsideLimits = 0;
  Durations period, delay, drawing, handing;  ///< sent to sent; tick's beginning to sent; drawing begun to frame there; frame there to sent
  LongCourse delayCourse;                     ///< [ns]
  std::int64_t lastSent_ns = -1;
  std::uint64_t accounted() const { return onTime + late + dropped + repeated; }
};

class StreamAccount {
 public:
  explicit StreamAccount(const std::vector<std::string>& cameras);
  /// Before it is handed over, so that its stamp counts itself; times are of the monotonic clock.
  struct Sending {
    std::int64_t tick_ns = 0, begun_ns = 0, made_ns = 0, sent_ns = 0;
    bool isLate = false, isRepeated = false;
  };
  void sent(std::size_t camera, FrameStamp& stamp, const Sending& times);
  void dropped(std::size_t camera);
  CameraAccount of(std::size_t camera) const;
  std::size_t cameras() const { return cameras_.size(); }

 private:
  mutable std::mutex mutex_;
  std::vector<CameraAccount> cameras_;
};

}  // namespace pitviper
