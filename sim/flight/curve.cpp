#include "sim/flight/curve.hpp"

#include <algorithm>
#include <cmath>

#include "sim/flight/flight_error.hpp"

namespace pitviper {

double curveAt(std::span<const CurvePoint> points, double x, double none) {
  if (points.empty()) return none;
  if (!(x > points.front().x)) return points.front().y;
  if (!(x < points.back().x)) return points.back().y;
  const auto next = std::upper_bound(points.begin(), points.end(), x, [](double at, const CurvePoint& p) { return at < p.x; });
  const CurvePoint &a = *(next - 1), &b = *next;
  return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
}

void checkCurve(const std::string& option, std::span<const CurvePoint> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y)) throw FlightError(option, "not a finite number", "finite numbers", "correct the point", i);
    if (points[i].y < 0.0) throw FlightError(option, "below 0: " + std::to_string(points[i].y), "0 or more", "correct the point", i);
    if (i > 0 && !(points[i].x > points[i - 1].x))
      throw FlightError(option, "goes back from " + std::to_string(points[i - 1].x) + " to " + std::to_string(points[i].x), "rising numbers",
                        "put the points in order", i);
  }
}

}  // namespace pitviper
