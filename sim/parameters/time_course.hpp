#pragma once
// A number over simulation time, as a user's rows have it.
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "sim/parameters/fingerprint.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// Points in time with a value each. Linear: straight between points. Smooth: cubic, its slope continuous and never beyond the values of the points on either
/// side (Fritsch and Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM J. Sci. Stat. Comput. 5 (1984); at the ends the slope
/// of the chord). Steps: a value holds from its point on until the next. Before the first and after the last point: Hold the value there, Loop the course again
/// and again (its period is from the first point to the last), Zero.
class TimeCourse {
 public:
  enum class Interpolation { Linear, Smooth, Steps };
  enum class Outside { Hold, Loop, Zero };
  struct Point {
    double time_s = 0.0, value = 0.0;
    bool operator==(const Point&) const = default;
  };
  TimeCourse() = default;  ///< empty: says nothing, value 0
  /// Always the same.
  explicit TimeCourse(double value) : points_{{0.0, value}} {}
  /// Errors: std::invalid_argument for no points, numbers that are not finite, times that do not rise.
  explicit TimeCourse(std::vector<Point> points, Interpolation interpolation = Interpolation::Linear, Outside outside = Outside::Hold);

  bool empty() const { return points_.empty(); }
  bool isConstant() const { return points_.size() < 2 && outside_ == Outside::Hold; }
  double at(double time_s) const;
  /// Derivative [1/s]; at a bend or a step that of the stretch after it, 0 outside unless it loops.
  double slopeAt(double time_s) const;
  /// Least and greatest from one time to another, both within it.
  std::pair<double, double> range(double from_s = -std::numeric_limits<double>::infinity(), double to_s = std::numeric_limits<double>::infinity()) const;
  /// Times from one to another at which it bends, steps or has an extreme: its points, those of loops too, of many the first `most`.
  std::vector<double> bends_s(double from_s, double to_s, std::size_t most = 64) const;
  double begin_s() const { return points_.front().time_s; }
  double end_s() const { return points_.back().time_s; }
  const std::vector<Point>& points() const { return points_; }
  Interpolation interpolation() const { return interpolation_; }
  Outside outside() const { return outside_; }
  /// The same with its values times a factor, or its times later.
  TimeCourse scaled(double factor) const;
  TimeCourse later(double by_s) const;
  bool operator==(const TimeCourse&) const = default;

 private:
  double wrapped(double time_s) const;
  std::size_t legOf(double time_s) const;
  std::pair<double, double> slopes(std::size_t leg) const;
  std::vector<Point> points_;
  Interpolation interpolation_ = Interpolation::Linear;
  Outside outside_ = Outside::Hold;
};

/// Whether a user wrote a course and not one number: a list of rows, or a map with `over`.
bool isCourse(const Value& value);
/// One number, or rows [time, value], or a map as courseTable() has it. `unit`, `low` and `high` are of the values; `outside` is what holds unless said.
/// Errors: UserError at the row or number: times that do not rise, wrong units, values out of range.
TimeCourse readCourse(const Value& value, std::string_view unit, std::string_view name, double low = -std::numeric_limits<double>::infinity(),
                      double high = std::numeric_limits<double>::infinity(), TimeCourse::Outside outside = TimeCourse::Outside::Hold);
/// The map `{over: [[0 s, 300 K], ...], interpolation, outside}`, for the key reference.
const ParameterTable& courseTable();

void addTo(Fingerprint& f, const TimeCourse& course);

}  // namespace pitviper
