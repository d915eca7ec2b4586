#pragma once
// What somebody changes by hand while a scenario is shown: it is seen in the next picture, without a new plan, and can be written into the scenario.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/view/yaml_edit.hpp"
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

/// All of them as keys; a camera that something carries is told in its carrier's axes at that time.
std::vector<YamlChange> keysOf(const Simulation& simulation, const HandChanges& hands, double time_s);

}  // namespace pitviper
