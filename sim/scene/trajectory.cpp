#include "sim/scene/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace pitviper {
namespace {

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Position between two points as a polynomial of s = 0 to 1, relative to the first.
struct Piece {
  std::array<glm::dvec3, 6> c{};
  double h = 0.0;

  Piece(const TrajectoryPoint& a, const TrajectoryPoint& b, bool quintic) : h(b.time_s - a.time_s) {
    const glm::dvec3 step = b.position - a.position, v0 = a.velocity * h, v1 = b.velocity * h;
    c[1] = v0;
    if (quintic) {
      const glm::dvec3 a0 = a.acceleration * (h * h), a1 = b.acceleration * (h * h);
      const glm::dvec3 dp = step - v0 - 0.5 * a0, dv = v1 - v0 - a0, da = a1 - a0;
      c[2] = 0.5 * a0;
      c[3] = 10.0 * dp - 4.0 * dv + 0.5 * da;
      c[4] = -15.0 * dp + 7.0 * dv - da;
      c[5] = 6.0 * dp - 3.0 * dv + 0.5 * da;
    } else {
      const glm::dvec3 dp = step - v0, dv = v1 - v0;
      c[2] = 3.0 * dp - dv;
      c[3] = dv - 2.0 * dp;
    }
  }
  glm::dvec3 position(double s) const { return s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5])))); }
  glm::dvec3 velocity(double s) const { return (c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4] + s * (5.0 * c[5]))))) / h; }
  glm::dvec3 acceleration(double s) const { return (2.0 * c[2] + s * (6.0 * c[3] + s * (12.0 * c[4] + s * (20.0 * c[5])))) / (h * h); }
};

/// Time within a loop, from its begin; rounding can bring it to the end, which is as good.
double looped(double t, double begin, double period) { return begin + (t - begin) - period * std::floor((t - begin) / period); }

}  // namespace

struct Trajectory::Place {
  std::size_t from = 0;   ///< point before
  double s = 0.0;         ///< share of the way to the next
  double beyond_s = 0.0;  ///< time past an end that is passed with its velocity
  bool still = false, onWay = true;
};

Trajectory::Trajectory(std::vector<TrajectoryPoint> points, AtEnd before, AtEnd after, Interpolation interpolation)
    : before_(before), after_(after), interpolation_(interpolation) {
  if (points.empty()) throw std::invalid_argument("a trajectory without points");
  for (std::size_t i = 0; i < points.size(); ++i) {
    TrajectoryPoint& p = points[i];
    const double length = glm::length(p.orientation);
    if (!std::isfinite(p.time_s) || !finite(p.position) || !finite(p.velocity) || !finite(p.acceleration) || !std::isfinite(length))
      throw std::invalid_argument("a trajectory's point " + std::to_string(i) + " is not finite");
    if (!(length > 0.0)) throw std::invalid_argument("a trajectory's point " + std::to_string(i) + " has no orientation");
    if (i > 0 && !(p.time_s > points[i - 1].time_s)) throw std::invalid_argument("a trajectory's time does not rise at point " + std::to_string(i));
    p.orientation /= length;
  }
  points_ = std::make_shared<const std::vector<TrajectoryPoint>>(std::move(points));
}

Trajectory::Place Trajectory::placeOf(double t) const {
  const std::vector<TrajectoryPoint>& all = *points_;
  const bool early = t<begin_s(), late = t> end_s();
  Place place;
  if (early || late) {
    const AtEnd end = early ? before_ : after_;
    if (end != AtEnd::Loop || all.size() == 1) {
      place.from = early ? 0 : all.size() - 1;
      place.onWay = false;
      place.still = end != AtEnd::GoOn;
      place.beyond_s = place.still ? 0.0 : t - all[place.from].time_s;
      return place;
    }
    t = std::clamp(looped(t, begin_s(), end_s() - begin_s()), begin_s(), end_s());
  }
  if (all.size() == 1) {
    place.onWay = false;
    return place;
  }
  const auto next = std::upper_bound(all.begin() + 1, all.end() - 1, t, [](double time, const TrajectoryPoint& p) { return time < p.time_s; });
  place.from = static_cast<std::size_t>(next - all.begin()) - 1;
  place.s = (t - all[place.from].time_s) / (next->time_s - all[place.from].time_s);
  return place;
}

Pose Trajectory::at(double time_s) const {
  const Place place = placeOf(time_s);
  const TrajectoryPoint& a = (*points_)[place.from];
  if (!place.onWay) return {a.position + a.velocity * place.beyond_s, a.orientation};
  const TrajectoryPoint& b = (*points_)[place.from + 1];
  // At s = 1 the point itself, without the rounding of a sum.
  if (place.s >= 1.0) return {b.position, b.orientation};
  return {a.position + Piece(a, b, interpolation_ == Interpolation::Quintic).position(place.s),
          glm::normalize(glm::slerp(a.orientation, b.orientation, place.s))};
}

glm::dvec3 Trajectory::velocityAt(double time_s) const {
  const Place place = placeOf(time_s);
  const TrajectoryPoint& a = (*points_)[place.from];
  if (!place.onWay) return place.still ? glm::dvec3(0.0) : a.velocity;
  return Piece(a, (*points_)[place.from + 1], interpolation_ == Interpolation::Quintic).velocity(place.s);
}

glm::dvec3 Trajectory::accelerationAt(double time_s) const {
  const Place place = placeOf(time_s);
  if (!place.onWay) return glm::dvec3(0.0);
  return Piece((*points_)[place.from], (*points_)[place.from + 1], interpolation_ == Interpolation::Quintic).acceleration(place.s);
}

bool Trajectory::presentAt(double time_s) const {
  if (time_s < begin_s()) return before_ != AtEnd::Vanish;
  if (time_s > end_s()) return after_ != AtEnd::Vanish;
  return true;
}

void Trajectory::addTo(Fingerprint& f) const {
  f.add(static_cast<int>(before_)).add(static_cast<int>(after_)).add(static_cast<int>(interpolation_)).add(static_cast<double>(points_->size()));
  for (const TrajectoryPoint& p : *points_) f.add(p.time_s).add(p.position).add(p.velocity).add(p.acceleration).add(p.orientation);
}

Trajectory Trajectory::withEnds(AtEnd before, AtEnd after) const {
  Trajectory other = *this;
  other.before_ = before;
  other.after_ = after;
  return other;
}

}  // namespace pitviper
