#pragma once
// A scenario as it is read from one as it is written: files put together, parameters and expressions worked out, repeated entries written out.
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/value.hpp"

namespace pitviper {

/// Of one repeated entry.
constexpr int kMostRepeats = 4096;

struct ExpandedScenario {
  Value tree;            ///< without `include`, `extends`, `parameters`, `repeat`, with overrides; every value has the place where it was written
  std::string identity;  ///< all texts that it came from, and the overrides
};

/// `text` is that of the file `fileName`; relative files are found from `base`, those in included files from these files' own folders. Overrides of
/// `parameters.` hold before all else, others at the end. What comes out has at most kMostYamlNodes values, 256 MB of text and places, and kDeepestYaml levels.
/// Errors: UserError with the place of what cannot be included, is not known, is no number, has another unit, or holds itself.
ExpandedScenario expandScenario(const std::string& text, const std::string& fileName, const std::filesystem::path& base,
                                const std::vector<std::string>& overrides, const Libraries& libraries, const std::vector<std::filesystem::path>& roots);

/// What readScenarioText() makes of it. Errors: UserError.
Simulation readExpanded(const ExpandedScenario& expanded, const std::string& fileName, const std::filesystem::path& base, const Libraries& libraries);

}  // namespace pitviper
