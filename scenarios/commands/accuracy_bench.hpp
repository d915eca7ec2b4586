#pragma once
// The speed and accuracy table of `bench --accuracy`.
#include <string>

namespace pitviper {

/// Prints a table of frames per second and error against spectral samples for the first camera of a scenario.
int accuracyBench(const std::string& scenario);

}  // namespace pitviper
