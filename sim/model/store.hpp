#pragma once
// What a body carries and a command may eject: nothing of it is there before.
#include <functional>
#include <memory>
#include <string>

#include "sim/parameters/time_course.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

/// One that has been ejected: how it flies and burns. What is drawn of it (lights, fields) says of which store it is.
struct Ejected {
  std::shared_ptr<const Trajectory> path;
  TimeCourse level;  ///< over the simulation's time; 0 outside
  double lit_s = 0.0, out_s = 0.0;
};

struct Store {
  std::string name;
  int carrier = -1;  ///< index of the entity that ejects it; -1: it starts where it says, from rest
  /// From a carrier of that pose and velocity [m/s]. Called from several threads.
  std::function<std::shared_ptr<const Ejected>(double time_s, const Pose& carrier, const glm::dvec3& velocity)> eject;
  /// Since ejection, between which it shines [s].
  double lit_s = 0.0, out_s = 0.0;
};

}  // namespace pitviper
