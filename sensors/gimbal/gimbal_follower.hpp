#pragma once
// A gimbal's loop behind the kernel's contract of what points a camera.
#include "sensors/gimbal/follow_loop.hpp"
#include "sim/model/follower.hpp"

namespace pitviper {

/// `film`: the whole film, which pictures for look() have. `record`: of a replay; else null.
std::unique_ptr<Follower> makeGimbalFollower(const FollowOptions& options, std::shared_ptr<const PoseRecord> record = nullptr);

}  // namespace pitviper
