#pragma once
// `bench --first` and what it starts, `bench --once`.
#include "scenarios/commands/options.hpp"

namespace pitviper {

/// Each takes the words of `bench` without its own option.
int firstCommand(const Arguments& arguments);
int onceCommand(const Arguments& arguments);

}  // namespace pitviper
