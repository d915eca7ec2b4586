#pragma once
// `sweep --solve`: at which value of a factor a measure has a value.
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/sweep/sweep_file.hpp"

namespace pitviper {

struct SweepGoal {
  std::string goal;    ///< "snr = 5"
  std::string factor;  ///< that is varied
  int repeats = 16;
};

/// Prints what was tried and found. Errors: UserError. Returns the exit code.
int solveSweep(const Sweep& sweep, const std::vector<std::filesystem::path>& roots, const SweepGoal& goal);

}  // namespace pitviper
