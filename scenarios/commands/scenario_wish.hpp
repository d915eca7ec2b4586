#pragma once
// A scenario as a command line asks for it, with what is changed in it.
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/commands/options.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

struct ScenarioWish {
  std::string file;
  std::vector<std::string> changes = {};          ///< "path.to.key=value"
  std::vector<std::filesystem::path> roots = {};  ///< folders from which it may take parts, besides its own
  /// Errors: UserError.
  Simulation read() const;
};

/// `--set` and `--root`. With `needs`: they do nothing without that option.
std::vector<Option> scenarioOptions(ScenarioWish& wish, const std::string& needs = {});
Option rootOption(ScenarioWish& wish, const std::string& needs = {});

/// First and last of --frames, "a:b" or "a"; of all if empty. Errors: UserError where the scenario has no such frames.
std::pair<int, int> framesWanted(const std::string& text, const Simulation& simulation);

}  // namespace pitviper
