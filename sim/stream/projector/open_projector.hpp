#pragma once
// A scene projector's display for those who are not linked with GLFW.
#include <memory>

#include "sim/stream/projector/projector_module.hpp"

namespace pitviper {

/// Black until the first frame. Takes some dozens of the display's periods, in which its rate is measured. One at a time. Leaves the calling thread's OpenGL
/// context alone.
/// Errors: UserError where there is no display, no such monitor, a monitor too small for a frame, or where GLFW or the module is not installed;
/// std::invalid_argument for a size or a scale below 1, or more than 65536 levels.
std::unique_ptr<Projector> openProjector(const ProjectorOptions& options);

}  // namespace pitviper
