#pragma once
// Another program of the system, run to its end, and what it says.
#include <optional>
#include <string>
#include <vector>

namespace pitviper {

struct ProgramResult {
  int code = 1;  ///< 128 and a signal's number where one ended it
  std::string output, errors;
};

/// Runs words[0], which is looked for on PATH, with the other words as they are: no shell reads them. It has nothing to read, and this process's environment
/// without the variables `without`. Nothing: there is no such program. Throws std::runtime_error where no process can be made.
std::optional<ProgramResult> runProgram(std::vector<std::string> words, const std::vector<std::string>& without = {});

}  // namespace pitviper
