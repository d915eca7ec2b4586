#include "sim/scene/camera.hpp"

#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

double Pinhole::apertureArea_m2() const { return 0.25 * kPi * apertureDiameter_m * apertureDiameter_m; }

double Pinhole::integral(int column, int row, int power) const {
  // dOmega = cos^3(psi) dx dy on a film at unit distance; 3-point Gauss-Legendre in each direction.
  static const double at[3] = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
  static const double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double x = tanX(column + at[i]), y = tanY(row + at[j]);
      sum += weight[i] * weight[j] * std::pow(1.0 + x * x + y * y, -0.5 * power);
    }
  return sum * (pitchX_m / focalLength_m) * (pitchY_m / focalLength_m);
}

double Pinhole::solidAngle_sr(int column, int row) const { return integral(column, row, 3); }
double Pinhole::projectedSolidAngle_sr(int column, int row) const { return integral(column, row, 4); }

Pinhole::SolidAngles Pinhole::solidAngles() const {
  SolidAngles all;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  all.plain_sr.reserve(pixels), all.projected_sr.reserve(pixels);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      all.plain_sr.push_back(solidAngle_sr(column, row));
      all.projected_sr.push_back(projectedSolidAngle_sr(column, row));
    }
  return all;
}

glm::dquat steadied(const Steadied& angles, const glm::dquat& carrier) {
  Attitude a = attitudeOf(carrier);
  if (angles.heading) a.heading_rad = angles.heading_rad;
  if (angles.pitch) a.pitch_rad = 0.0;
  if (angles.roll) a.roll_rad = 0.0;
  return orientationFrom(a);
}

glm::dmat3 localFromCamera(const Pose& pose) {
  const glm::dvec3 x = pose.orientation * glm::dvec3(1, 0, 0);
  const glm::dvec3 y = pose.orientation * glm::dvec3(0, 1, 0);
  const glm::dvec3 z = pose.orientation * glm::dvec3(0, 0, 1);
  return {-y, z, -x};
}

}  // namespace pitviper
