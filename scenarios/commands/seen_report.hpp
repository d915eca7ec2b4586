#pragma once
// What each camera of a scenario sees, for people.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

struct SeenReport {
  /// For each camera, in the first, the middle and the last frame: a line a body, many alike in one, with size, range, size in pixels and whether
  /// it is seen. Empty where there is no body. With thousands of bodies and many cameras the first frame only.
  std::string text;
  /// Lines "note: ...": meshes whose unit is doubtful, cameras that see no body at all.
  std::string notes;
};
SeenReport reportSeen(const Simulation& simulation);

}  // namespace pitviper
