#include "sim/world/view.hpp"

#include <cmath>

namespace pitviper {

View cameraView(const Camera& camera, const WorldState& state, int samples) {
  const CameraState at = cameraAt(camera, state);
  const Pinhole& pinhole = at.pinhole;
  View v;
  v.width = pinhole.width * samples;
  v.height = pinhole.height * samples;
  v.tanPerPixelX = pinhole.pitchX_m / pinhole.focalLength_m / samples;
  v.tanPerPixelY = pinhole.pitchY_m / pinhole.focalLength_m / samples;
  v.axisX = 0.5 * v.width;
  v.axisY = 0.5 * v.height;
  v.position = at.pose.position;
  v.localFromCamera = localFromCamera(at.pose);
  v.near_m = camera.near_m;
  v.pixelTan2 = pinhole.pitchX_m * pinhole.pitchY_m / (pinhole.focalLength_m * pinhole.focalLength_m);
  return v;
}

bool mayShow(const View& v, const glm::dvec3& centre, double radius) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (centre - v.position);
  if (p.z > radius) return false;
  // Inward normals of the sides through the film's edges at tangents t: x + t z <= 0 inside on the right, and so on.
  auto beyond = [&](double across, double tangent) { return across + tangent * p.z > radius * std::sqrt(1.0 + tangent * tangent); };
  const double left = v.axisX * v.tanPerPixelX, right = (v.width - v.axisX) * v.tanPerPixelX;
  const double low = v.axisY * v.tanPerPixelY, high = (v.height - v.axisY) * v.tanPerPixelY;
  return !(beyond(p.x, right) || beyond(-p.x, left) || beyond(p.y, high) || beyond(-p.y, low));
}

}  // namespace pitviper
