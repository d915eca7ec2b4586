#include "sim/scene/route_clock.hpp"

#include <algorithm>
#include <cmath>

#include "sim/scene/trajectory.hpp"

namespace pitviper {
namespace {

/// Steps over which the way is added up (Simpson's rule): speeds of routes change over seconds. Of very long ones as many as take a few milliseconds.
constexpr double kStep_s = 0.05, kMostSteps = 16384.0;

}  // namespace

RouteClock::RouteClock(const Motion& motion, double from_s) : from_s_(from_s) {
  const AtEnd before = motion.before(), after = motion.after();
  const double begin = motion.begin_s(), end = motion.end_s();
  loops_ = after == AtEnd::Loop;
  double first = from_s;
  if (from_s < begin && before != AtEnd::GoOn && before != AtEnd::Loop) first = begin, waits_s_ = begin - from_s;
  const double last = loops_ ? first + (end - begin) : std::max(first, end);
  // Points of a route are corners of its speed.
  std::vector<double> corners{first};
  for (const Waypoint& w : motion.waypoints())
    if (w.time_s > first && w.time_s < last) corners.push_back(w.time_s);
  corners.push_back(last);
  time_s_ = {first};
  way_m_ = {0.0};
  const double step = std::max(kStep_s, (last - first) / kMostSteps);
  const auto speedAt = [&](double t) { return glm::length(motion.velocityAt(t)); };
  for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
    const double length = corners[c + 1] - corners[c];
    const int parts = static_cast<int>(std::ceil(length / step));
    for (int k = 0; k < parts; ++k) {
      const double a = corners[c] + length * k / parts, b = corners[c] + length * (k + 1) / parts, inside = 1e-9 * (b - a);
      time_s_.push_back(b);
      way_m_.push_back(way_m_.back() + (b - a) / 6.0 * (speedAt(a + inside) + 4.0 * speedAt(0.5 * (a + b)) + speedAt(b - inside)));
    }
  }
  lastSpeed_m_s_ = after == AtEnd::GoOn ? speedAt(last + 1.0) : 0.0;
}

double RouteClock::at(double speed_m_s, double after_s) const {
  if (after_s < waits_s_ || speed_m_s == 0.0) return from_s_ + std::min(after_s, waits_s_);
  const double all = way_m_.back();
  double way = speed_m_s * (after_s - waits_s_), rounds_s = 0.0;
  if (loops_ && all > 0.0 && way >= all) {
    rounds_s = std::floor(way / all) * (time_s_.back() - time_s_.front());
    way = std::fmod(way, all);
  }
  if (way >= all) return time_s_.back() + (way - all) / (lastSpeed_m_s_ > 0.0 ? lastSpeed_m_s_ : speed_m_s);
  const auto next = static_cast<std::size_t>(std::upper_bound(way_m_.begin(), way_m_.end(), way) - way_m_.begin());
  const double part = (way - way_m_[next - 1]) / (way_m_[next] - way_m_[next - 1]);
  return time_s_[next - 1] + part * (time_s_[next] - time_s_[next - 1]) + rounds_s;
}

double RouteClock::rate(double speed_m_s) const {
  constexpr double kSoon_s = 1e-4;
  return (at(speed_m_s, kSoon_s) - at(speed_m_s, 0.0)) / kSoon_s;
}

}  // namespace pitviper
