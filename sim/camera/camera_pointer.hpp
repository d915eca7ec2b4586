#pragma once
// A camera's follower in a run: ticked once a frame, in order, whatever is drawn of it.
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "sim/world/world.hpp"

namespace pitviper {

/// Where a camera looked as its picture was drawn.
struct CameraPointing {
  Followed followed;
  std::optional<glm::dvec2>
      target_px;                   ///< where a pinhole sees the true place of what it looks at, right and down from the middle of the film; none: not before it
  std::optional<Tracked> tracked;  ///< in this picture, once it has been looked at
};

class CameraPointer {
 public:
  /// Both must outlive it; the camera has a follower.
  CameraPointer(const Simulation& simulation, const Camera& camera);
  /// Ticks frames up to this one: all from the scenario's first on of one that remembers, and this alone of another. Those before it have no pictures, unless
  /// look() was called after each. A frame that is ticked already stays.
  void tickTo(const StateAt& world, int frame);
  /// The world with the camera where it is: at the last tick's time there, at times around it as it moves. Until the next tick.
  StateAt around(const StateAt& world) const;
  /// Of the last tick.
  const CameraPointing& pointing() const { return pointing_; }
  /// `picture`: of FollowerChoice::output, as the frame has it (the camera's window, if it has one).
  Tracked look(std::span<const float> picture);
  bool looks() const { return camera_.follower->output.has_value(); }
  bool remembers() const { return camera_.follower->remembers; }
  std::string takeRecord() { return follower_->takeRecord(); }

 private:
  const Simulation& simulation_;
  const Camera& camera_;
  std::unique_ptr<Follower> follower_;
  CameraPointing pointing_;
  int ticked_ = std::numeric_limits<int>::min();
  double time_s_ = 0.0;
};

}  // namespace pitviper
