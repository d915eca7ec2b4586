#pragma once
// Pinhole projection with a real aperture and a flat film.
#include <string>
#include <vector>

#include "sim/scene/motion.hpp"

namespace pitviper {

/// Camera axes: x right, y up, looking along -z. Row 0 of an image is the top.
struct Pinhole {
  int width = 0, height = 0;
  double focalLength_m = 0.0;
  double pitchX_m = 0.0, pitchY_m = 0.0;
  double apertureDiameter_m = 0.0;

  double apertureArea_m2() const;
  /// Edges within tangents of 30 (176 deg from edge to edge): beyond, a flat film has hardly any light.
  bool isFlat() const { return 0.5 * width * pitchX_m / focalLength_m <= 30.0 && 0.5 * height * pitchY_m / focalLength_m <= 30.0; }
  /// Tangents of the angles of a film position (pixels from the top left corner) from the axis: right, up.
  double tanX(double column) const { return (column - 0.5 * width) * pitchX_m / focalLength_m; }
  double tanY(double row) const { return (0.5 * height - row) * pitchY_m / focalLength_m; }
  /// Solid angle of a pixel [sr], integral of dOmega; relative error below 1e-9 for pixels under 3 degrees.
  double solidAngle_sr(int column, int row) const;
  /// Both for every pixel, row by row from the top.
  struct SolidAngles {
    std::vector<double> plain_sr, projected_sr;
  };
  SolidAngles solidAngles() const;
  /// Projected solid angle [sr], integral of cos(psi) dOmega: radiance times this is irradiance on the aperture.
  double projectedSolidAngle_sr(int column, int row) const;

 private:
  double integral(int column, int row, int power) const;
};

/// Angles of its carrier's attitude that a platform between the two keeps from a camera: pitch and roll are 0 (level) then, the heading is the one given.
struct Steadied {
  bool heading = false, pitch = false, roll = false;
  double heading_rad = 0.0;
  bool any() const { return heading || pitch || roll; }
};

/// The attitude that such a platform has on a carrier.
glm::dquat steadied(const Steadied& angles, const glm::dquat& carrier);

/// How a camera or a light is carried and where it looks.
struct Mount {
  Motion motion;          ///< in the local frame, or in the carrier's body frame
  int carrier = -1;       ///< entity index, or -1
  int lookAtEntity = -1;  ///< entity index, or -1
  int lookAtLight = -1;   ///< index of a point light, or -1; of nothing to look at: along the motion's own x axis
  bool looksAtPoint = false;
  glm::dvec3 lookAtPoint{0.0};
  Steadied steadied;  ///< of a camera that is carried
};

/// Columns: camera x (right), y (up), z (backward) in the local frame.
glm::dmat3 localFromCamera(const Pose& pose);

}  // namespace pitviper
