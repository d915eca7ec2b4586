#include "sim/run/stream_account.hpp"

namespace pitviper {

StreamAccount::StreamAccount(const std::vector<std::string>& cameras) {
  for (const std::string& name : cameras) cameras_.emplace_back().camera = name;
}

void StreamAccount::sent(std::size_t camera, FrameStamp& stamp, const Sending& t) {
  const std::lock_guard lock(mutex_);
  CameraAccount& a = cameras_[camera];
  ++(t.isRepeated ? a.repeated : t.isLate ? a.late : a.onTime);
  if (stamp.isOutsideLimits) ++a.outsideLimits;
  if (a.lastSent_ns >= 0) a.period.add(t.sent_ns - a.lastSent_ns);
  a.lastSent_ns = t.sent_ns;
  a.delay.add(t.sent_ns - t.tick_ns);
  a.delayCourse.add(static_cast<double>(t.sent_ns - t.tick_ns));
  if (!t.isRepeated) {
    a.drawing.add(t.made_ns - t.begun_ns);
    a.handing.add(t.sent_ns - t.made_ns);
  }
  stamp.isLate = t.isLate;
  stamp.isRepeated = t.isRepeated;
  stamp.dropped = a.dropped, stamp.late = a.late, stamp.repeated = a.repeated;
}

void StreamAccount::dropped(std::size_t camera) {
  const std::lock_guard lock(mutex_);
  ++cameras_[camera].dropped;
}

CameraAccount StreamAccount::of(std::size_t camera) const {
  const std::lock_guard lock(mutex_);
  return cameras_[camera];
}

}  // namespace pitviper
