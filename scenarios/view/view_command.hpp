#pragma once
// The command that opens a window.
#include "scenarios/commands/options.hpp"

namespace pitviper {

CommandLine viewCommand();

}  // namespace pitviper
