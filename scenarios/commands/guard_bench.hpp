#pragma once
// `bench --guard`: figures of a file, measured again.
#include <functional>
#include <optional>

#include "scenarios/commands/guard_file.hpp"

namespace pitviper {

struct GuardResult {
  GuardLine line;
  std::optional<double> now;  ///< as the file has it: seconds by the yardstick
  std::string why;            ///< of one that could not be measured, or that does not count here
};

/// Growth that is named.
inline constexpr double kGuarded = 0.2;

/// So that machines compare: seconds as they would be where the yardstick gives 6 million pixels a second, processor seconds as where it takes so many of two
/// processors; a frame as frames of the yardstick.
/// `next`: told what begins. Errors: as of measureFirst() and of the bench.
std::vector<GuardResult> measureGuard(const std::vector<GuardLine>& lines, const std::function<void(const std::string&)>& next);

/// Lines that are not blank, of all C++ and GLSL below a folder.
long codeLines(const std::filesystem::path& folder);

bool hasGrown(const GuardResult& result);
bool hasShrunk(const GuardResult& result);

/// All figures as a table, then a line for each that has grown, could not be measured, or has shrunk.
std::string guardText(const std::vector<GuardResult>& results, const std::string& file);

}  // namespace pitviper
