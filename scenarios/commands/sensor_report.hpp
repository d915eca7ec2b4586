#pragma once
// What `check` says of a camera's lens and detector.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// A line for each of its channels; empty for a camera without stages. `step_s`: from frame to frame.
std::string sensorText(const Camera& camera, double step_s);

}  // namespace pitviper
