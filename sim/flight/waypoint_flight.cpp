#include "sim/flight/waypoint_flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sim/flight/flight_axes.hpp"
#include "sim/parameters/print.hpp"
#include "sim/scene/gravity.hpp"

namespace pitviper {
namespace {

using Reason = WaypointRefusal::Reason;

constexpr double kMostPoints = 1e6;     // 112 MB
constexpr double kStraight_rad = 1e-9;  // a turn below it moves nothing by a micrometre within 1 km
constexpr double kBack_rad = 1e-6;      // of half a turn: the plane of such a turn is rounding
constexpr double kSharpest = 0.1;       // share of weight that is left to bank against when it pushes over

struct Motion3 {
  glm::dvec3 position, velocity, acceleration;
};

/// A straight leg (turn 0) or an arc, flown with a speed that changes evenly.
struct Element {
  glm::dvec3 from, ahead, inward{0.0};
  double length_m = 0.0, radius_m = 0.0, speed0_m_s = 0.0, speed1_m_s = 0.0;

  double duration_s() const { return 2.0 * length_m / (speed0_m_s + speed1_m_s); }
  Motion3 at(double t) const {
    const double gain = (speed1_m_s - speed0_m_s) / duration_s(), way = (speed0_m_s + 0.5 * gain * t) * t, speed = speed0_m_s + gain * t;
    if (radius_m == 0.0) return {from + way * ahead, speed * ahead, gain * ahead};
    const double angle = way / radius_m, c = std::cos(angle), s = std::sin(angle);
    const glm::dvec3 forward = c * ahead + s * inward, in = c * inward - s * ahead;
    return {from + radius_m * (s * ahead + (1.0 - c) * inward), speed * forward, gain * forward + speed * speed / radius_m * in};
  }
};

std::string number(double value) { return print("%.3g", value); }

/// Legs are straight on a map: metres east and north along great circles from the origin, at a mean height, and height.
class Map {
 public:
  Map(std::span<const FlightWaypoint> waypoints, const WaypointFlightOptions& options, const LocalFrame& frame)
      : curved_(options.followEarth), earth_m_(frame.earthRadius_m() - frame.ground_m()), centre_(0.0, 0.0, -earth_m_ - frame.origin().height_m) {
    double sum = 0.0;
    for (const FlightWaypoint& w : waypoints) sum += glm::length(w.position - centre_);
    sphere_m_ = sum / static_cast<double>(waypoints.size());
  }
  glm::dvec3 onto(const glm::dvec3& local) const {
    if (!curved_) return local;
    const glm::dvec3 r = local - centre_;
    const double across = std::hypot(r.x, r.y), angle = std::atan2(across, r.z), scale = across > 0.0 ? sphere_m_ * angle / across : 0.0;
    return {r.x * scale, r.y * scale, glm::length(r) - earth_m_};
  }
  glm::dvec3 up(const glm::dvec3& local) const { return curved_ ? glm::normalize(local - centre_) : glm::dvec3(0.0, 0.0, 1.0); }
  Motion3 from(const Motion3& m) const {
    if (!curved_) return m;
    const double across = std::hypot(m.position.x, m.position.y), angle = across / sphere_m_, radius = earth_m_ + m.position.z;
    const glm::dvec3 out = across > 0.0 ? glm::dvec3(m.position.x / across, m.position.y / across, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 side(-out.y, out.x, 0.0), top(std::sin(angle) * out + glm::dvec3(0.0, 0.0, std::cos(angle)));
    const glm::dvec3 outward = std::cos(angle) * out - glm::dvec3(0.0, 0.0, std::sin(angle));
    const double alongScale = radius / sphere_m_, sideScale = alongScale * (angle > 0.0 ? std::sin(angle) / angle : 1.0);
    const auto turned = [&](const glm::dvec3& v) { return alongScale * glm::dot(v, out) * outward + sideScale * glm::dot(v, side) * side + v.z * top; };
    const glm::dvec3 velocity = turned(m.velocity);
    // A great circle bends down by v^2/r; the map's own distortion changes too slowly to count.
    const double level2 = glm::dot(velocity, velocity) - m.velocity.z * m.velocity.z;
    return {centre_ + radius * top, velocity, turned(m.acceleration) - level2 / radius * top};
  }

 private:
  bool curved_;
  double earth_m_, sphere_m_ = 1.0;
  glm::dvec3 centre_;
};

struct Corner {
  double angle_rad = 0.0, turn_g = 0.0, radius_m = 0.0, tangent_m = 0.0;
};

std::string nameOf(std::size_t waypoint) { return "waypoint " + std::to_string(waypoint + 1); }

void checkInput(std::span<const FlightWaypoint> points, const WaypointFlightOptions& o) {
  const auto refuse = [](Reason reason, std::size_t i, const std::string& text) { throw WaypointRefusal(reason, i, 0.0, 0.0, text); };
  if (points.size() < 2) refuse(Reason::FewPoints, 0, "a flight along waypoints needs two of them at least");
  if (!(o.mostLateral_g > 0.0) || !(o.mostLongitudinal_g > 0.0) || !(o.step_s > 0.0) || !(o.bankTime_s >= 0.0) || !std::isfinite(o.bankTime_s) ||
      !std::isfinite(o.begin_s))
    refuse(Reason::Option, 0, "limits and step of a flight along waypoints must be above 0");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(glm::dot(points[i].position, points[i].position)) || !std::isfinite(points[i].speed_m_s))
      refuse(Reason::NotFinite, i, nameOf(i) + " is not finite");
    const bool end = i == 0 || i + 1 == points.size();
    if (points[i].speed_m_s < 0.0 || (!end && points[i].speed_m_s == 0.0))
      refuse(Reason::NoSpeed, i, nameOf(i) + " is passed at " + number(points[i].speed_m_s) + " m/s: give a speed above 0");
    if (points[i].turn_g && !(*points[i].turn_g > 0.0))
      refuse(Reason::Option, i, nameOf(i) + " turns with " + number(*points[i].turn_g) + " g: give more than 0");
    if (points[i].turn_g && *points[i].turn_g > o.mostLateral_g)
      throw WaypointRefusal(Reason::TurnAboveLimit, i, *points[i].turn_g, o.mostLateral_g,
                            nameOf(i) + " turns with " + number(*points[i].turn_g) + " g where " + number(o.mostLateral_g) + " g are allowed");
  }
}

class Layout {
 public:
  Layout(std::span<const FlightWaypoint> points, const WaypointFlightOptions& options, const Map& map) : points_(points), options_(options) {
    for (const FlightWaypoint& w : points) places_.push_back(map.onto(w.position));
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
      const double length = glm::length(places_[i + 1] - places_[i]);
      if (!(length > 0.0)) throw WaypointRefusal(Reason::SamePlace, i + 1, 0.0, 0.0, nameOf(i + 1) + " is where the one before it is");
      lengths_.push_back(length);
      directions_.push_back((places_[i + 1] - places_[i]) / length);
    }
    corners_.resize(places_.size());
    for (std::size_t i = 1; i + 1 < places_.size(); ++i) corners_[i] = cornerAt(i);
    checkTurns();
  }

  std::vector<Element> elements() const {
    std::vector<Element> all;
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
      addLeg(i, all);
      if (const Corner& corner = corners_[i + 1]; corner.radius_m > 0.0) all.push_back(arcAt(i + 1, corner));
    }
    return all;
  }

 private:
  Corner cornerAt(std::size_t i) const {
    Corner corner;
    const glm::dvec3 &a = directions_[i - 1], &b = directions_[i];
    corner.angle_rad = 2.0 * std::atan2(glm::length(b - a), glm::length(b + a));  // exact at both ends (Kahan)
    if (corner.angle_rad < kStraight_rad) return corner;
    const double pi = std::acos(-1.0);
    if (corner.angle_rad > pi - kBack_rad)
      throw WaypointRefusal(Reason::TurnsBack, i, 0.0, 0.0, nameOf(i) + " turns straight back: put a waypoint to one side, which tells where to turn");
    corner.turn_g = points_[i].turn_g.value_or(options_.mostLateral_g);
    corner.radius_m = points_[i].speed_m_s * points_[i].speed_m_s / (corner.turn_g * kStandardGravity);
    corner.tangent_m = corner.radius_m * std::tan(0.5 * corner.angle_rad);
    return corner;
  }

  /// The turn that lacks most room is named, with the g at which the leg would have room for both turns at its ends.
  void checkTurns() const {
    double worst = 1.0 + 1e-9;  // legs that are just long enough, as rounded
    std::size_t leg = lengths_.size();
    for (std::size_t i = 0; i < lengths_.size(); ++i)
      if (const double demand = (corners_[i].tangent_m + corners_[i + 1].tangent_m) / lengths_[i]; demand > worst) worst = demand, leg = i;
    if (leg == lengths_.size()) return;
    const std::size_t at = corners_[leg].tangent_m > corners_[leg + 1].tangent_m ? leg : leg + 1;
    const double allowed = corners_[at].turn_g, needed = allowed * worst;
    throw WaypointRefusal(Reason::TurnTooTight, at, needed, allowed,
                          nameOf(at) + " needs a turn of " + number(needed) + " g at " + number(points_[at].speed_m_s) + " m/s where " + number(allowed) +
                              " g are allowed: the leg of " + number(lengths_[leg]) + " m is too short; move it, fly slower or allow more");
  }

  void addLeg(std::size_t i, std::vector<Element>& all) const {
    const double length = lengths_[i] - corners_[i].tangent_m - corners_[i + 1].tangent_m, v0 = points_[i].speed_m_s, v1 = points_[i + 1].speed_m_s;
    const bool none = length <= 1e-9 * lengths_[i];
    if (v0 + v1 == 0.0) throw WaypointRefusal(Reason::NoSpeed, i + 1, 0.0, 0.0, nameOf(i + 1) + " cannot be reached: its leg begins and ends at rest");
    if (v0 != v1) {
      const double needed = none ? std::numeric_limits<double>::infinity() : std::abs(v1 * v1 - v0 * v0) / (2.0 * length * kStandardGravity);
      if (needed > options_.mostLongitudinal_g)
        throw WaypointRefusal(Reason::SpeedChange, i + 1, needed, options_.mostLongitudinal_g,
                              nameOf(i + 1) + " needs " + number(needed) + " g along its leg to go from " + number(v0) + " to " + number(v1) + " m/s in " +
                                  number(std::max(length, 0.0)) + " m where " + number(options_.mostLongitudinal_g) + " g are allowed");
    }
    if (none) return;
    Element leg;
    leg.from = places_[i] + corners_[i].tangent_m * directions_[i];
    leg.ahead = directions_[i];
    leg.length_m = length;
    leg.speed0_m_s = v0;
    leg.speed1_m_s = v1;
    all.push_back(leg);
  }

  Element arcAt(std::size_t i, const Corner& corner) const {
    Element arc;
    arc.ahead = directions_[i - 1];
    arc.from = places_[i] - corner.tangent_m * arc.ahead;
    arc.inward = glm::normalize(directions_[i] - glm::dot(directions_[i], arc.ahead) * arc.ahead);
    arc.radius_m = corner.radius_m;
    arc.length_m = corner.radius_m * corner.angle_rad;
    arc.speed0_m_s = arc.speed1_m_s = points_[i].speed_m_s;
    return arc;
  }

  std::span<const FlightWaypoint> points_;
  const WaypointFlightOptions& options_;
  std::vector<glm::dvec3> places_, directions_;
  std::vector<double> lengths_;
  std::vector<Corner> corners_;
};

/// Roll about the path that brings the body's z to lift, against gravity and for what the path asks.
double bankOf(const glm::dvec3& velocity, const glm::dvec3& acceleration, const glm::dvec3& up) {
  const glm::dvec3 x = glm::normalize(velocity);
  if (glm::length(glm::cross(up, x)) < 1e-6) return 0.0;  // straight up: no bank to speak of
  const glm::dvec3 y = glm::normalize(glm::cross(up, x)), z = glm::cross(x, y), lift = acceleration + kStandardGravity * up;
  return std::atan2(-glm::dot(lift, y), std::max(glm::dot(lift, z), kSharpest * kStandardGravity));
}

/// Bank over time, with jumps at joints, as its integral: differences over a window are means.
class BankIntegral {
 public:
  void add(double time_s, double before, double after) {
    const double sum = times_.empty() ? 0.0 : sums_.back() + 0.5 * (last_ + before) * (time_s - times_.back());
    times_.push_back(time_s);
    sums_.push_back(sum);
    last_ = after;
  }
  double mean(double from, double to) const { return (at(to) - at(from)) / (to - from); }
  double begin_s() const { return times_.front(); }
  double end_s() const { return times_.back(); }

 private:
  double at(double t) const {
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - times_.begin());
    return sums_[i - 1] + (sums_[i] - sums_[i - 1]) * (t - times_[i - 1]) / (times_[i] - times_[i - 1]);
  }
  std::vector<double> times_, sums_;
  double last_ = 0.0;
};

}  // namespace

Trajectory flyWaypoints(std::span<const FlightWaypoint> waypoints, const WaypointFlightOptions& options, const LocalFrame& frame) {
  checkInput(waypoints, options);
  const Map map(waypoints, options, frame);
  const std::vector<Element> elements = Layout(waypoints, options, map).elements();
  double total_s = 0.0;
  for (const Element& e : elements) total_s += e.duration_s();
  if (!(total_s / options.step_s + static_cast<double>(elements.size()) < kMostPoints))
    throw WaypointRefusal(Reason::TooLong, waypoints.size() - 1, 0.0, 0.0,
                          "the flight of " + number(total_s) + " s takes more than a million steps: take longer ones");

  std::vector<TrajectoryPoint> points;
  std::vector<double> banks;
  BankIntegral bank;
  glm::dvec3 ahead(1.0, 0.0, 0.0);
  double begin_s = options.begin_s, last = 0.0;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const Element& e = elements[k];
    const double duration = e.duration_s();
    const auto parts = static_cast<int>(std::max(1.0, std::ceil(duration / options.step_s)));
    for (int i = 0; i <= parts; ++i) {
      const double into = duration * i / parts;
      const Motion3 m = map.from(e.at(into));
      const glm::dvec3 up = map.up(m.position);
      if (glm::length(m.velocity) > 0.0) ahead = m.velocity;
      else ahead = map.from({e.from, e.ahead, glm::dvec3(0.0)}).velocity;  // at rest, as it will go
      const double now = bankOf(ahead, m.acceleration, up);
      const bool joint = i == 0 && k > 0;
      // A joint is one point; its acceleration is the mean of both sides, its bank jumps.
      if (joint) {
        bank.add(begin_s, last, now);
        points.back().acceleration = 0.5 * (points.back().acceleration + m.acceleration);
        banks.back() = 0.5 * (last + now);
      } else {
        points.push_back({begin_s + into, m.position, m.velocity, m.acceleration, orientationWithTop(ahead, up)});
        banks.push_back(now);
        if (i < parts || k + 1 == elements.size()) bank.add(begin_s + into, now, now);
      }
      last = now;
    }
    begin_s += duration;
  }
  if (options.bank)
    for (std::size_t i = 0; i < points.size(); ++i) {
      double roll = banks[i];
      const double from = std::max(points[i].time_s - 0.5 * options.bankTime_s, bank.begin_s());
      const double to = std::min(points[i].time_s + 0.5 * options.bankTime_s, bank.end_s());
      if (to > from) roll = bank.mean(from, to);
      points[i].orientation = points[i].orientation * glm::angleAxis(roll, glm::dvec3(1.0, 0.0, 0.0));
    }
  return Trajectory(std::move(points), options.before, options.after);
}

}  // namespace pitviper
