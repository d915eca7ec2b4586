#pragma once
// What the tests of transparent things are held against, written without any of the program's own formulas: rays of a camera, chords of
// convex bodies by bisection, and radiance along a ray by marching in small steps.
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"

namespace pitviper::test {

struct Line {
  glm::dvec3 origin, direction;  ///< of unit length
  glm::dvec3 at(double s) const { return origin + s * direction; }
};

/// A square camera in the local frame that looks at a place (not straight up or down).
struct Eye {
  glm::dvec3 position, target;
  double field_deg = 10.0;
  int pixels = 24;
  /// Its YAML, as the only one: film, optics, place and `more` (whole lines, 4 blanks in front), then these channels in brackets.
  std::string yaml(const std::string& channels, const std::string& more = "") const;
  /// Through the middle of a pixel, row 0 on top.
  Line ray(int column, int row) const;
};

/// A body's axes: heading clockwise from north and pitch [deg], no roll; columns x forward, y left, z up.
glm::dmat3 axesOf(double heading_deg, double pitch_deg = 0.0);
std::string text(double value);
std::string text(const glm::dvec3& place);

/// Stretch of a ray [m]; leave <= enter: none.
struct Stretch {
  double enter = 0.0, leave = 0.0;
  double length() const { return leave > enter ? leave - enter : 0.0; }
};

/// A convex body, by a function that is convex and below 0 inside, in body coordinates.
using Gauge = std::function<double(const glm::dvec3&)>;
Gauge ellipsoidGauge(const glm::dvec3& semiAxes);
Gauge frustumGauge(double halfLength, double baseRadius, double topRadius);
Gauge boxGauge(const glm::dvec3& halves);

/// Where a line is inside: the lowest gauge between `from` and `to` by golden section, then bisection to both sides. Lengths are counted
/// from the body's own middle inside, so that they keep their digits far away.
Stretch chordOf(const Gauge& gauge, const Line& inBody, double from, double to);
/// The same for a body at a place; `reach` bounds its size [m].
Stretch chordOf(const Gauge& gauge, const Line& line, const glm::dvec3& place, const glm::dmat3& axes, double reach);

/// Absorbs `absorption` per metre on a stretch and emits absorption x source.
struct Fog {
  Stretch where;
  double absorption_per_m = 0.0, source = 0.0;
};
/// Radiance behind times transmittance, plus its own.
struct Sheet {
  double range = 0.0, transmittance = 1.0, own = 0.0;
};

/// Radiance at the camera: dL/ds = sum of k S - L sum of k from `end` (radiance `behind`) to 0 by the classical Runge-Kutta method, at most
/// 1/32 of optical depth a step (error below 1e-8), stopping at every edge and sheet.
double march(double end, double behind, const std::vector<Fog>& fogs, const std::vector<Sheet>& sheets);

/// Worst relative error over a frame's first layer, against a function of column and row; pixels for which that is NaN are left out.
/// `covered`, if asked for, counts those compared.
double worstError(const Frame& frame, const std::function<double(int, int)>& expected, int* covered = nullptr);

}  // namespace pitviper::test
