#include "sim/render/view.hpp"

namespace pitviper {

View cameraView(const Pinhole& pinhole, const Pose& pose, double near_m, int samples) {
  View v;
  v.width = pinhole.width * samples;
  v.height = pinhole.height * samples;
  v.tanPerPixelX = pinhole.pitchX_m / pinhole.focalLength_m / samples;
  v.tanPerPixelY = pinhole.pitchY_m / pinhole.focalLength_m / samples;
  v.axisX = 0.5 * v.width;
  v.axisY = 0.5 * v.height;
  v.position = pose.position;
  v.localFromCamera = localFromCamera(pose);
  v.near_m = near_m;
  return v;
}

}  // namespace pitviper
