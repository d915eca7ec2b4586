#pragma once
// The contract of what changes a world besides what its scenario says of time: commands, of a scenario, a script or a network.
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "sim/scene/motion.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// A value over simulation time: also between two frames, so that an exposure has a beginning and an end.
template <class T>
using Course = std::function<T(double time_s)>;

/// What commands have set: each course takes the place of what the scenario says. Indices are Simulation's.
struct Courses {
  std::map<int, Course<glm::dvec3>> positions;                   ///< by entity; in the local frame, or in the carrier's
  std::map<int, Course<glm::dquat>> orientations;                ///< the same
  std::map<std::pair<int, int>, Course<double>> temperatures_K;  ///< by entity and surface; not of one with a temperature texture
  std::map<int, Course<double>> lightLevels;                     ///< by point light
  std::map<std::string, Course<glm::dvec3>> cameraPositions;     ///< by name, as of CameraChange
  std::map<std::string, Course<glm::dquat>> cameraOrientations;
  std::map<std::string, Course<double>> focalLengths_m, exposures_s;
  std::map<std::string, Course<double>> gains;  ///< factors of the detector's own
  std::map<std::pair<std::string, std::string>, Course<double>> channelExposures_s, channelGains;  ///< by camera and channel, of channels that have their own
  std::map<std::string, std::vector<Pointing>> pointings;  ///< of cameras on gimbals: the newest (addPointing)
};

/// A command's time and a frame's are the same where they lie within this part of a tick: sums of steps round.
constexpr double kSameTick = 1e-6;

/// From its time on until another says otherwise. One that was sent for a time before the tick that takes it holds from that tick on, its courses as of its
/// own time: a body that moves is where it has got to since.
struct Command {
  double at_s = 0.0;
  std::string words;  ///< what it depends on: two with the same words are the same
  std::function<void(Courses& courses, double at_s)> change;
};

}  // namespace pitviper
