#pragma once
// The contract of what changes a world besides what its scenario says of time: commands, of a scenario, a script or a network.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/store.hpp"
#include "sim/scene/motion.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// A value over simulation time: also between two frames, so that an exposure has a beginning and an end.
template <class T>
using Course = std::function<T(double time_s)>;

/// A throttle that commands have set: from each time on a value, before the first as the scenario has it.
struct ThrottleSteps {
  std::vector<std::pair<double, double>> steps;  ///< times rise
  std::optional<double> at(double time_s) const {
    std::optional<double> value;
    for (const auto& [from_s, is] : steps)
      if (from_s <= time_s) value = is;
    return value;
  }
};

/// A body that was put somewhere: when, where, and how fast it is since.
struct Moved {
  double at_s = 0.0;
  glm::dvec3 position{0.0}, velocity{0.0};  ///< in the local frame, or in the carrier's
};

/// What commands have set: each course takes the place of what the scenario says. Indices are Simulation's.
struct Courses {
  std::map<int, Course<glm::dvec3>> positions;                   ///< by entity; in the local frame, or in the carrier's
  std::map<int, Course<glm::dquat>> orientations;                ///< the same
  std::map<int, Moved> moved;                                    ///< of those in `positions`
  std::map<int, Course<double>> routeTimes_s;                    ///< by entity: the time for which it is where its own motion has it
  std::map<int, std::shared_ptr<const ThrottleSteps>> throttles; ///< by field
  std::map<int, std::shared_ptr<const Ejected>> ejected;         ///< by store
  std::vector<std::pair<int, double>> toEject;                   ///< stores and times: who carries commands out knows from where (World)
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

/// Puts a body somewhere, to go on with a velocity. One that is not told is 0, but of what follows that body (an exhaust, a flare that it ejects) it is that
/// since the move before, where that is no longer ago than kSameWay_s and no faster than kFastest_m_s: hosts that send a place a frame seldom send velocities.
void move(Courses& courses, int entity, double at_s, const glm::dvec3& position, const std::optional<glm::dvec3>& velocity);
constexpr double kSameWay_s = 1.0, kFastest_m_s = 1e4;

/// From its time on until another says otherwise. One that was sent for a time before the tick that takes it holds from that tick on, its courses as of its
/// own time: a body that moves is where it has got to since.
struct Command {
  double at_s = 0.0;
  std::string words;  ///< what it depends on: two with the same words are the same
  std::function<void(Courses& courses, double at_s)> change;
};

}  // namespace pitviper
