#pragma once
// Where an axis of a chart begins and ends, and what stands along it.
#include <string>
#include <vector>

namespace pitviper {

/// In the axis' own coordinate: the value, or its decimal logarithm.
struct AxisLayout {
  double low = 0.0, high = 1.0;
  std::vector<double> ticks;
  std::vector<std::string> labels;
  std::string power;  ///< what the labels are to be multiplied by, or nothing
};

/// Coordinate of a value; NaN where it has none.
double axisCoordinate(double value, bool logarithmic);

/// Whether a linear axis of values that are nowhere negative begins at 0.
enum class Zero {
  Ignored,
  IfNear,  ///< where otherwise half of the axis or less would be cut off
  Always
};

/// An axis for these values (those without a coordinate are ignored), a little wider than they. `ticks`: exactly these, if any.
AxisLayout layOutAxis(const std::vector<double>& values, bool logarithmic, const std::vector<double>& ticks, Zero zero);

/// One place per category, at 0, 1, 2 ...
AxisLayout layOutCategories(const std::vector<std::string>& categories);

}  // namespace pitviper
