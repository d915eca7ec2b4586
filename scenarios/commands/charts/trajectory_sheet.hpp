#pragma once
// A scene of trajectories on one picture, drawn off screen.
#include "scenarios/commands/trajectory_picture.hpp"
#include "sim/image/picture.hpp"

namespace pitviper {

/// Makes a GlContext of its own, current on this thread until it returns. Throws std::exception where it fails.
Rgb8Image drawTrajectorySheet(const FlownScene& scene);

}  // namespace pitviper
