#pragma once
// A number over another, straight between points and constant outside: drag over Mach number, area over time.
#include <span>
#include <string>
#include <vector>

namespace pitviper {

struct CurvePoint {
  double x = 0.0, y = 0.0;
};

/// Straight between points, held outside; `none` without points. x rises.
double curveAt(std::span<const CurvePoint> points, double x, double none = 0.0);

/// Errors: FlightError naming `option` and the point where x does not rise, a number is not finite or y is below 0.
void checkCurve(const std::string& option, std::span<const CurvePoint> points);

}  // namespace pitviper
