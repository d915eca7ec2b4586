#include "sim/parameters/time_course.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace pitviper {
namespace {

/// Times of rows lie this far apart at least: slopes stay finite, as those of a motion's waypoints.
constexpr double kClosest_s = 1e-9;
/// A million seconds are eleven days; a double then still tells a nanosecond.
constexpr double kLongest_s = 1e6;
constexpr std::size_t kMostRows = 100000;

}  // namespace

TimeCourse::TimeCourse(std::vector<Point> points, Interpolation interpolation, Outside outside)
    : points_(std::move(points)), interpolation_(interpolation), outside_(outside) {
  if (points_.empty()) throw std::invalid_argument("a course without points");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!std::isfinite(points_[i].time_s) || !std::isfinite(points_[i].value)) throw std::invalid_argument("a course with a point that is not finite");
    if (i > 0 && !(points_[i].time_s > points_[i - 1].time_s)) throw std::invalid_argument("a course whose time goes back");
  }
}

double TimeCourse::wrapped(double t) const {
  if (outside_ != Outside::Loop || points_.size() < 2 || (t >= begin_s() && t <= end_s())) return t;
  const double period = end_s() - begin_s();
  return std::clamp(t - period * std::floor((t - begin_s()) / period), begin_s(), end_s());
}

std::size_t TimeCourse::legOf(double t) const {
  const auto next = std::upper_bound(points_.begin() + 1, points_.end() - 1, t, [](double time, const Point& p) { return time < p.time_s; });
  return static_cast<std::size_t>(next - points_.begin()) - 1;
}

/// Of a smooth course at both ends of a leg.
std::pair<double, double> TimeCourse::slopes(std::size_t leg) const {
  const auto step = [this](std::size_t i) { return points_[i + 1].time_s - points_[i].time_s; };
  const auto chord = [&](std::size_t i) { return (points_[i + 1].value - points_[i].value) / step(i); };
  const auto at = [&](std::size_t i) {
    if (i == 0) return chord(0);
    if (i + 1 == points_.size()) return chord(i - 1);
    const double before = chord(i - 1), after = chord(i);
    if (!(before * after > 0.0)) return 0.0;
    const double share = (step(i - 1) + 2.0 * step(i)) / (3.0 * (step(i - 1) + step(i)));
    return before * after / (share * after + (1.0 - share) * before);
  };
  return {at(leg), at(leg + 1)};
}

double TimeCourse::at(double time_s) const {
  if (points_.empty()) return 0.0;
  const double t = wrapped(time_s);
  if (t < begin_s()) return outside_ == Outside::Zero ? 0.0 : points_.front().value;
  if (t > end_s()) return outside_ == Outside::Zero ? 0.0 : points_.back().value;
  if (points_.size() == 1 || t == end_s()) return points_.back().value;
  const std::size_t leg = legOf(t);
  const Point &a = points_[leg], &b = points_[leg + 1];
  if (interpolation_ == Interpolation::Steps) return a.value;
  const double h = b.time_s - a.time_s, s = (t - a.time_s) / h;
  if (interpolation_ == Interpolation::Linear) return a.value + s * (b.value - a.value);
  const auto [m0, m1] = slopes(leg);
  const double s2 = s * s, s3 = s2 * s;
  const double value = (2.0 * s3 - 3.0 * s2 + 1.0) * a.value + (s3 - 2.0 * s2 + s) * h * m0 + (3.0 * s2 - 2.0 * s3) * b.value + (s3 - s2) * h * m1;
  return std::clamp(value, std::min(a.value, b.value), std::max(a.value, b.value));  // rounding
}

double TimeCourse::slopeAt(double time_s) const {
  if (points_.size() < 2 || interpolation_ == Interpolation::Steps) return 0.0;
  const double t = wrapped(time_s);
  if (t < begin_s() || t >= end_s()) return 0.0;
  const std::size_t leg = legOf(t);
  const Point &a = points_[leg], &b = points_[leg + 1];
  const double h = b.time_s - a.time_s, s = (t - a.time_s) / h;
  if (interpolation_ == Interpolation::Linear) return (b.value - a.value) / h;
  const auto [m0, m1] = slopes(leg);
  return 6.0 * s * (1.0 - s) * (b.value - a.value) / h + (3.0 * s * s - 4.0 * s + 1.0) * m0 + (3.0 * s * s - 2.0 * s) * m1;
}

std::pair<double, double> TimeCourse::range(double from_s, double to_s) const {
  if (points_.empty()) return {0.0, 0.0};
  const auto far = [](double t) { return std::isfinite(t); };
  double low = INFINITY, high = -INFINITY;
  const auto take = [&](double v) { low = std::min(low, v), high = std::max(high, v); };
  take(at(far(from_s) ? from_s : begin_s() - 1.0));
  take(at(far(to_s) ? to_s : end_s() + 1.0));
  // Between its points a course lies between their values; one that loops for as long as it lasts has them all.
  const bool loops = outside_ == Outside::Loop && points_.size() > 1 && (from_s < begin_s() || to_s > end_s());
  if (loops && !(to_s - from_s < end_s() - begin_s())) {
    for (const Point& p : points_) take(p.value);
    return {low, high};
  }
  if (loops) {
    // Points as they come round, those of rounding beside the window too; a period's end is the next one's begin, and both are met.
    const double period = end_s() - begin_s();
    for (double shift = period * (std::floor((from_s - begin_s()) / period) - 1.0); begin_s() + shift <= to_s + kClosest_s; shift += period)
      for (const Point& p : points_)
        if (const double t = p.time_s + shift; t >= from_s - kClosest_s && t <= to_s + kClosest_s) take(p.value);
    return {low, high};
  }
  for (const Point& p : points_)
    if (p.time_s >= from_s && p.time_s <= to_s) take(p.value);
  // Of a step that is left within the time the value before it counts too, and that before the first where it is zero there.
  if (outside_ == Outside::Zero && (from_s < begin_s() || to_s > end_s())) take(0.0);
  return {low, high};
}

std::vector<double> TimeCourse::bends_s(double from_s, double to_s, std::size_t most) const {
  std::vector<double> found;
  const bool loops = outside_ == Outside::Loop && points_.size() > 1;
  const double period = loops ? end_s() - begin_s() : 0.0;
  const double turn = loops ? std::floor((from_s - begin_s()) / period) : 0.0;
  for (double shift = turn * period; found.size() < most; shift += period) {
    if (begin_s() + shift > to_s) break;
    for (const Point& p : points_)
      if (const double t = p.time_s + shift; t >= from_s && t <= to_s && found.size() < most && (found.empty() || t > found.back())) found.push_back(t);
    if (!loops) break;
  }
  return found;
}

TimeCourse TimeCourse::scaled(double factor) const {
  TimeCourse other = *this;
  for (Point& p : other.points_) p.value *= factor;
  return other;
}

TimeCourse TimeCourse::later(double by_s) const {
  TimeCourse other = *this;
  for (Point& p : other.points_) p.time_s += by_s;
  return other;
}

const ParameterTable& courseTable() {
  static const ParameterTable t{
      "course",
      "A number over time. Keys of type 'number or course' take one number, or rows `[[0 s, 300 K], [2 s, 800 K]]` with rising times, or a map of these keys "
      "to "
      "say more of the rows.",
      {required(list("over", "rows [time, value], each later than the one before", 1, kMostRows)),
       withDefault(choice("interpolation", {"linear", "smooth", "steps"},
                          "between rows: straight, a cubic that stays between the values of its rows, or each value until the next row"),
                   "linear"),
       choice("outside", {"hold", "loop", "zero"}, "before the first row and after the last; hold unless a key says otherwise")}};
  return t;
}

bool isCourse(const Value& value) {
  if (value.kind == Value::Kind::Map) return value.find("over") != nullptr;
  return value.kind == Value::Kind::List && !value.items.empty() && value.items.front().kind == Value::Kind::List;
}

TimeCourse readCourse(const Value& value, std::string_view unit, std::string_view name, double low, double high, TimeCourse::Outside outside) {
  const std::string what(name);
  const auto number = [&](const Value& v) {
    const double x = readNumber(v, unit, name);
    if (x >= low && x <= high) return x;
    std::ostringstream range;
    range << (std::isfinite(low) && std::isfinite(high) ? "" : std::isfinite(low) ? "at least " : "at most ");
    const double shown = unit == "rad" ? 57.29577951308232 : 1.0;  // people write degrees
    if (std::isfinite(low)) range << low * shown;
    if (std::isfinite(low) && std::isfinite(high)) range << " to ";
    if (std::isfinite(high)) range << high * shown;
    range << (unit.empty() ? "" : " ") << (unit == "rad" ? "deg" : unit);
    throw UserError(v.where, what + " is out of range (" + v.text.substr(0, 60) + ")", range.str(), "correct the value");
  };
  if (value.kind == Value::Kind::Scalar) return TimeCourse(number(value));
  const Value* rows = &value;
  TimeCourse::Interpolation interpolation = TimeCourse::Interpolation::Linear;
  if (value.kind == Value::Kind::Map) {
    const Record r(value, courseTable());
    rows = &r.value("over");
    const std::string between = r.text("interpolation");
    if (between == "smooth") interpolation = TimeCourse::Interpolation::Smooth;
    if (between == "steps") interpolation = TimeCourse::Interpolation::Steps;
    if (r.given("outside")) {
      const std::string said = r.text("outside");
      outside = said == "hold" ? TimeCourse::Outside::Hold : said == "loop" ? TimeCourse::Outside::Loop : TimeCourse::Outside::Zero;
    }
  }
  const std::string shape = "rows of a time and a value: [[0 s, ...], [2 s, ...]]";
  asList(*rows, what);
  if (rows->items.empty() || rows->items.size() > kMostRows)
    throw UserError(rows->where, what + " over time has " + std::to_string(rows->items.size()) + " rows", "1 to " + std::to_string(kMostRows) + " rows",
                    rows->items.empty() ? "add rows" : "remove rows");
  std::vector<TimeCourse::Point> points;
  for (const Value& row : rows->items) {
    if (row.kind != Value::Kind::List || row.items.size() != 2) throw UserError(row.where, "not a row of " + what + " over time", shape, "write two values");
    const double t = readNumber(row.items[0], "s", "time of " + what);
    if (!(std::abs(t) <= kLongest_s))
      throw UserError(row.items[0].where, "a time of " + what + " is out of range (" + row.items[0].text.substr(0, 40) + ")", "-1e6 to 1e6 s",
                      "correct the time");
    if (!points.empty() && !(t >= points.back().time_s + kClosest_s))
      throw UserError(row.items[0].where, "the times of " + what + " do not rise: this row is not later than the one before",
                      "each row later than the one before", "sort the rows, or remove one");
    points.push_back({t, number(row.items[1])});
  }
  if (outside == TimeCourse::Outside::Loop && points.size() < 2)
    throw UserError(rows->where, what + " loops over one row", "two rows at least: the period is from the first to the last", "add a row");
  return TimeCourse(std::move(points), interpolation, outside);
}

void addTo(Fingerprint& f, const TimeCourse& c) {
  f.add(static_cast<double>(c.points().size()));
  for (const TimeCourse::Point& p : c.points()) f.add(p.time_s).add(p.value);
  f.add(static_cast<double>(static_cast<int>(c.interpolation()))).add(static_cast<double>(static_cast<int>(c.outside())));
}

}  // namespace pitviper
