#include "sim/run/accuracy_dial.hpp"

#include <algorithm>

namespace pitviper {
namespace {

// Of a period: above the first a tick leaves no room for what the system does besides; a finer rung must fit into the second.
constexpr double kFull = 0.95, kRoom = 0.8;
constexpr int kTooLong = 3;                                                   // ticks more than those that fitted: one slow frame is no reason
constexpr std::int64_t kShortest_ns = 2000000000, kLongest_ns = 60000000000;  // between a turn and one to a finer rung
constexpr double kNewest = 0.1;                                               // share of the newest tick in the running mean

}  // namespace

AccuracyDial::AccuracyDial(std::vector<double> work_ns, std::int64_t period_ns)
    : work_ns_(std::move(work_ns)), frames_(work_ns_.size()), period_ns_(static_cast<double>(period_ns)), wait_ns_(kShortest_ns) {
  while (rung_ + 1 < work_ns_.size() && work_ns_[rung_] > kFull * period_ns_) ++rung_;
}

void AccuracyDial::turn(std::size_t rung, std::int64_t now_ns) {
  // Where a finer one did not hold it is tried again ever more rarely: the picture is not to swing.
  if (rung > rung_) wait_ns_ = std::min(2 * wait_ns_, kLongest_ns);
  rung_ = rung;
  turned_ns_ = now_ns;
  over_ = 0;
  ++turns_;
}

void AccuracyDial::look(std::size_t drawn, std::int64_t work_ns, bool isLate, std::int64_t now_ns) {
  ++frames_[drawn];
  const double before = work_ns_[drawn];
  work_ns_[drawn] += kNewest * (static_cast<double>(work_ns) - before);
  // More or less in view is so for all of them: what the others take goes with the one that is drawn.
  if (before > 0.0)
    for (std::size_t r = 0; r < work_ns_.size(); ++r)
      if (r != drawn) work_ns_[r] *= work_ns_[drawn] / before;
  if (drawn != rung_) return;  // begun before the dial turned
  over_ = std::max(0, over_ + (isLate || static_cast<double>(work_ns) > kFull * period_ns_ ? 1 : -1));
  if (over_ >= kTooLong && rung_ + 1 < work_ns_.size()) turn(rung_ + 1, now_ns);
  else if (rung_ > 0 && over_ == 0 && now_ns - turned_ns_ > wait_ns_ && work_ns_[rung_ - 1] < kRoom * period_ns_) turn(rung_ - 1, now_ns);
}

}  // namespace pitviper
