#pragma once
// What a frame's header says of what points its camera.
#include "sim/camera/camera_pointer.hpp"
#include "sim/frame/frame.hpp"

namespace pitviper {

/// `pitviper.gimbal.driver` ("truth", "centroid", "commands", "poses"), `.mode`, `.locked` (0 or 1), `.angles_rad` (azimuth, elevation to its base) and
/// `.rates_rad_s` of these (not of poses); `.target_px`: where a pinhole sees the true place of what the camera looks at, right and down from the middle of the
/// film. Of a centroid: `.found` (0 or 1) and, if it is, `.centroid_px` (column, row in the film), `.track_error_px` (its distance from the middle of the
/// film),
/// `.signal` above the background, `.background`, `.threshold`, `.pixels`, `.saturated`.
void addPointing(Frame& frame, const CameraPointing& pointing);

}  // namespace pitviper
