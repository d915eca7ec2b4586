#pragma once
// A tape7 run in a few lines, for people.
#include <string>

#include "atmosphere/tape7.hpp"

namespace pitviper {

/// Kind, model, path, wavelengths and step, mean transmittance in 3-5 and 8-12 um where covered; each line ended.
std::string describe(const Tape7Run& run);

}  // namespace pitviper
