#include "sim/camera/scattering_by_second.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>
#include <utility>

#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// What it gives way by to threads that draw.
constexpr int kGivesWay = 10;

bool isSame(const CameraState& a, const CameraState& b) {
  return a.pose.position == b.pose.position && a.pose.orientation == b.pose.orientation && a.pinhole.focalLength_m == b.pinhole.focalLength_m;
}

}  // namespace

void ScatteringBySecond::lookAt(double second_s) {
  if (asked_s_ == second_s) return;
  asked_s_ = second_s;
  asked_ = std::async(std::launch::async, [this, second_s] {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kGivesWay);
    return check_.at(advance(simulation_, second_s));
  });
}

void ScatteringBySecond::begin(const WorldState& state) {
  if (!check_.looks()) return;
  second_s_ = std::max(std::floor(state.time_s), simulation_.time.at(0));
  if (found_s_ == second_s_) return;
  follows_ = isSame(cameraAt(camera_, state), cameraAt(camera_, advance(simulation_, state.time_s)));
  if (follows_) return lookAt(second_s_);
  found_ = check_.at(state);
  found_s_ = second_s_;
}

const std::vector<ScatteredAgain>& ScatteringBySecond::finish() {
  if (asked_.valid() && asked_s_ == second_s_ && found_s_ != second_s_) {
    found_ = asked_.get();
    found_s_ = second_s_;
    asked_s_.reset();  // it would be asked for anew
  }
  if (std::exchange(isFirst_, false) || !follows_) return found_;
  lookAt(second_s_ + 1.0);
  return found_;
}

}  // namespace pitviper
