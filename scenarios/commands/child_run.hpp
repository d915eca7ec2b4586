#pragma once
// This program again, as a process of its own: what it takes is then its own, and nothing of it is warm.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenarios/commands/commands.hpp"

namespace pitviper {

struct ChildResult {
  int code = 1;        ///< as of the commands; 128 and a signal's number where one ended it
  std::string output;  ///< both streams together
};

/// Runs `pitviper` with these arguments and waits for it. `environment`: variables that it has besides this process's own, or instead. SIGINT, SIGTERM and
/// SIGHUP meanwhile end it too, and its code says so. Throws std::runtime_error where no process can be made.
ChildResult runChild(const Arguments& arguments, const std::map<std::string, std::string>& environment);

/// Several at once, waited for together. `tick`: called some times a second meanwhile.
std::vector<ChildResult> runChildren(const std::vector<Arguments>& all, const std::map<std::string, std::string>& environment,
                                     const std::function<void()>& tick = {});

}  // namespace pitviper
