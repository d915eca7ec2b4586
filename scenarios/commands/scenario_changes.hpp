#pragma once
// What a user changes and looks again: six small edits of any scenario, as --set has them.
#include <string>
#include <vector>

#include "scenarios/commands/scenario_wish.hpp"

namespace pitviper {

struct ScenarioChange {
  std::string name;               ///< "temperature"
  std::vector<std::string> sets;  ///< empty: the scenario can have no such change
  std::string words;              ///< "entities.jet.temperature 311 K -> 321 K", or why there is none
};

/// Names of all changes, in their order.
const std::vector<std::string>& scenarioChangeNames();

/// Each change once, of the first place that can have it: of a body that a camera looks at before others. Each has been read: the scenario with it is good, and
/// its pictures are others. Errors: UserError as of reading the scenario itself.
std::vector<ScenarioChange> changesOf(const ScenarioWish& scenario);

}  // namespace pitviper
