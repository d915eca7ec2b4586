#include "sim/camera/camera_pointer.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pitviper {

CameraPointer::CameraPointer(const Simulation& simulation, const Camera& camera)
    : simulation_(simulation), camera_(camera), follower_(camera.follower->make(simulation, camera)) {}

void CameraPointer::tickTo(const StateAt& world, int frame) {
  for (int next = remembers() ? std::max(ticked_ + 1, 0) : frame; next <= frame && frame > ticked_; ++next) {
    time_s_ = simulation_.time.at(next);
    const FollowerTick tick = followerTick(camera_, world(time_s_), next);
    pointing_ = {follower_->tick(tick), {}, {}};
    ticked_ = next;
    if (!tick.target) continue;
    const Pose& pose = pointing_.followed.pose;
    const glm::dvec3 line = glm::transpose(localFromCamera(pose)) * (*tick.target - pose.position);
    const Pinhole& p = camera_.pinhole;
    const double focal_m = tick.focalLength_m > 0.0 ? tick.focalLength_m : p.focalLength_m;
    if (line.z < 0.0) pointing_.target_px = glm::dvec2(line.x / -line.z * focal_m / p.pitchX_m, -line.y / -line.z * focal_m / p.pitchY_m);
  }
}

StateAt CameraPointer::around(const StateAt& world) const {
  return [this, world](double time_s) {
    WorldState state = world(time_s);
    const Pose pose = time_s == time_s_ ? pointing_.followed.pose : follower_->during(followerTick(camera_, state, ticked_));
    return pointed(std::move(state), camera_, pose);
  };
}

Tracked CameraPointer::look(std::span<const float> picture) {
  Tracked found;
  if (!camera_.window) {
    found = follower_->look(picture);
  } else {
    const glm::ivec4 w = *camera_.window;
    const auto width = static_cast<std::size_t>(camera_.pinhole.width);
    std::vector<float> film(width * static_cast<std::size_t>(camera_.pinhole.height), NAN);
    for (std::size_t row = 0; row < static_cast<std::size_t>(w.w); ++row)
      std::copy_n(picture.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(w.z)), w.z,
                  film.begin() + static_cast<std::ptrdiff_t>((row + static_cast<std::size_t>(w.y)) * width + static_cast<std::size_t>(w.x)));
    found = follower_->look(film);
  }
  pointing_.tracked = found;
  return found;
}

}  // namespace pitviper
