#pragma once
// Builds a simulation from a scenario file.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// Where the shipped libraries are; found from the program's own place, or PITVIPER_HOME.
struct Libraries {
  std::filesystem::path materials, atmosphere, sensors;
};
Libraries findLibraries();

/// Reads, checks and builds; nothing is rendered. `overrides` are "path.to.key=value"; `roots` further folders whose files it may include and extend. Every
/// mistake is a UserError.
Simulation readScenario(const std::filesystem::path& file, const std::vector<std::string>& overrides, const Libraries& libraries,
                        const std::vector<std::filesystem::path>& roots = {});

/// The same from text in memory; relative files are looked for in `base`.
Simulation readScenarioText(const std::string& text, const std::string& fileName, const std::filesystem::path& base, const std::vector<std::string>& overrides,
                            const Libraries& libraries, const std::vector<std::filesystem::path>& roots = {});

/// scenarios/README.md's key reference.
std::string keyReference();

}  // namespace pitviper
