#pragma once
// Frames a second of a scenario as it is: drawn, read back and resolved in memory, no files; beside the yardstick.
#include <map>
#include <string>
#include <vector>

#include "scenarios/commands/scenario_wish.hpp"

namespace pitviper {

struct ScenarioRate {
  std::string camera;
  int nodes = 0, channels = 0, frames = 0;
  double seconds = 0.0;                      ///< of a frame: mean
  double slow = 0.0;                         ///< 95 % of frames take no longer [s]
  double yardstickSeconds = 0.0;             ///< of the yardstick's frame between
  std::map<std::string, double> parts = {};  ///< seconds of each part of a frame
};

/// Every camera over the scenario's frames one after the other, from the first again where there are not so many.
std::vector<ScenarioRate> timeScenario(const ScenarioWish& scenario, int frames);

std::string rateTable(const std::vector<ScenarioRate>& rates);

}  // namespace pitviper
