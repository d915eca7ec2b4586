#include "sim/flight/closest_approach.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pitviper {

std::optional<double> closestInStep(const glm::dvec3& r0, const glm::dvec3& v0, const glm::dvec3& r1, const glm::dvec3& v1, double step_s) {
  if (!(glm::dot(r0, v0) < 0.0) || !(glm::dot(r1, v1) >= 0.0)) return std::nullopt;
  const glm::dvec3 m0 = v0 * step_s, m1 = v1 * step_s, dp = r1 - r0 - m0, dv = m1 - m0, c2 = 3.0 * dp - dv, c3 = dv - 2.0 * dp;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 52; ++i) {  // bits of a double's fraction
    const double s = 0.5 * (low + high);
    const glm::dvec3 r = r0 + s * (m0 + s * (c2 + s * c3)), v = m0 + s * (2.0 * c2 + 3.0 * s * c3);
    (glm::dot(r, v) < 0.0 ? low : high) = s;
  }
  return high * step_s;
}

ClosestApproach closestApproach(const PointMotion& a, const PointMotion& b, double begin_s, double end_s, double step_s) {
  if (!(step_s > 0.0) || !(end_s >= begin_s)) throw std::invalid_argument("a closest approach needs a step and an interval");
  const auto relative = [&](double t) {
    const MovingPoint from = a(t), to = b(t);
    return MovingPoint{to.position - from.position, to.velocity - from.velocity, {}};
  };
  ClosestApproach best{begin_s, glm::length(relative(begin_s).position)};
  const auto offer = [&](double t) {
    const double distance = glm::length(relative(t).position);
    if (distance < best.distance_m) best = {t, distance};
  };
  const double steps = std::ceil((end_s - begin_s) / step_s);
  MovingPoint last = relative(begin_s);
  double lastTime = begin_s;
  for (double k = 1.0; k <= steps; k += 1.0) {
    const double t = std::min(begin_s + k * step_s, end_s);
    const MovingPoint now = relative(t);
    offer(t);
    if (const auto into = closestInStep(last.position, last.velocity, now.position, now.velocity, t - lastTime)) offer(lastTime + *into);
    last = now, lastTime = t;
  }
  return best;
}

}  // namespace pitviper
