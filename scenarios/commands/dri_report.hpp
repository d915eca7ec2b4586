#pragma once
// How far a camera's observers detect, recognise and identify a target, and a threshold finds it as a spot, through a scenario's air.
#include <string>
#include <vector>

#include "scenarios/commands/measure_bench.hpp"
#include "sensors/acquisition.hpp"

namespace pitviper {

struct DriWish {
  std::string scenario;  ///< whose air
  AcquiredTarget target;
  double alarms_per_hour = 1.0;  ///< of a spot's threshold, over the whole film
};

struct DriReport {
  std::string about;  ///< target and air
  std::vector<std::string> rangeHead;
  std::vector<std::vector<std::string>> ranges;  ///< of tasks
  std::string aboutSpot;
  std::vector<std::string> spotHead;
  std::vector<std::vector<std::string>> spots;  ///< by range
  std::vector<Chart> charts;
};

/// Of a channel that a bench has measured, by its design. `air`: transmittance of its band over range, from a scenario whose words are `aboutAir`.
DriReport driReport(const BenchResult& bench, const DriWish& wish, const Transmittance& air, const std::string& aboutAir);

}  // namespace pitviper
