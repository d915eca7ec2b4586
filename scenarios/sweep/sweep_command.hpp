#pragma once
// pitviper sweep: a scenario drawn again and again with other values, on one machine or many.
#include "scenarios/commands/options.hpp"

namespace pitviper {

CommandLine sweepCommand();

}  // namespace pitviper
