#pragma once
// Whose a file is that a run would write: every file says which scenario it was made for.
#include <filesystem>
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// Names under which frames (attributes), previews (texts) and tables of probes (first line) keep them.
inline constexpr const char* kScenarioName = "pitviper.scenario";
inline constexpr const char* kScenarioHash = "pitviper.scenario_sha256";
/// The same in FITS, whose keywords have 8 letters.
inline constexpr const char *kFitsScenario = "SCENARIO", *kFitsHash = "SCENHASH";
/// And frames what it was made of.
inline constexpr const char* kScenarioContent = "pitviper.scenario_content";

/// The first line of a table of a probe, with its end.
std::string tableMark(const Simulation& simulation);

/// What a file of text, or with text in it, says at its beginning: in a comment, for instance.
std::string ownerMark(const Simulation& simulation);

/// UserError where `file` exists and is not of this scenario: of another, damaged, or no file of this program.
/// Looks at the beginning of the file only.
void refuseForeignFile(const std::filesystem::path& file, const Simulation& simulation);

}  // namespace pitviper
