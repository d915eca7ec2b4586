#pragma once
// The memory that drawing a simulation takes, told before it is drawn, beside what there is.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

struct MemoryNeed {
  double total_bytes = 0.0;
  double greatest_bytes = 0.0;  ///< part of the camera or probe that takes most
  std::string greatest;         ///< "camera seeker (8192x8192 pixels, 1x1 subpixels, 16 layers)"
  Location where;               ///< of that camera or probe
};

/// Of `run`, from the sizes of pictures alone: pictures on the GPU (on a driver without one in the same memory), copies read back, frames on their way to
/// files. Nothing is planned for it. An upper estimate: 1 to 2 times what was measured.
MemoryNeed memoryNeeded(const Simulation& simulation);

/// UserError at the camera or probe that takes most, where drawing would take more than there is.
void refuseBeyondMemory(const Simulation& simulation);

}  // namespace pitviper
