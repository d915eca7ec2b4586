#pragma once
// Where an open scene comes from: a scenario's file or its text, and what is changed in it.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/reader/expand.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

struct SceneSource {
  std::string file;                      ///< as messages name it
  std::optional<std::string> text = {};  ///< YAML; none: the file's
  std::filesystem::path base = {};       ///< from which the text's relative files are found
  std::vector<std::string> sets = {};    ///< "path.to.key=value"
  std::vector<std::filesystem::path> roots = {};

  /// The scenario as it is read: parts put together, expressions worked out, what is set in place. Errors: UserError.
  ExpandedScenario expanded() const;
  /// Such a one, or one that was made of it. Errors: UserError.
  Simulation read(const ExpandedScenario& expanded) const;
  /// With one more key set; what was set there before is forgotten.
  SceneSource with(const std::string& path, const std::string& yaml) const;

 private:
  std::filesystem::path folder() const;  ///< from which relative files are found
};

/// What stands at "cameras.seeker.exposure" in a tree: list items by number, from 0, or by their `name`. UserError where the path leads nowhere: a key that
/// the scenario leaves to its default stands nowhere.
const Value& valueAt(const Value& tree, const std::string& path);

}  // namespace pitviper
