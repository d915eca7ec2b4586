#pragma once
// What somebody changes by hand while a scenario is shown: it is seen in the next picture, without a new plan, and can be written into the scenario.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/world.hpp"

namespace pitviper {

struct HandChanges {
  std::map<std::string, Pose> flown;                     ///< of cameras that are flown: in the local frame, whatever carries them
  std::map<std::string, double> focalLengths_m;          ///< of cameras
  std::map<std::pair<int, int>, double> temperatures_K;  ///< by entity and surface
  std::map<int, double> lightLevels;                     ///< by point light
  bool operator==(const HandChanges&) const;
  bool any() const { return !flown.empty() || !focalLengths_m.empty() || !temperatures_K.empty() || !lightLevels.empty(); }
};

/// A scenario's world with hands in it, from a frame on. The simulation must outlive it.
StateAt worldWith(const Simulation& simulation, const HandChanges& hands, double time_s);

/// A change as a scenario's key: "cameras.seeker.position" and its value as YAML.
struct KeyChange {
  std::string path, value;
};
/// All of them as keys; a camera that something carries is told in its carrier's axes at that time.
std::vector<KeyChange> keysOf(const Simulation& simulation, const HandChanges& hands, double time_s);

}  // namespace pitviper
