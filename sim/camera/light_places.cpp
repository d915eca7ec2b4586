#include "sim/camera/light_places.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {

void addMoments(Moments& m, const glm::dvec2& at, double weight) {
  const Moments one{at.x, at.y, at.x * at.x, at.x * at.y, at.y * at.y};
  for (size_t k = 0; k < m.size(); ++k) m[k] += weight * one[k];
}

std::optional<Place> placeOf(double sum, const Moments& m) {
  if (!(std::abs(sum) > 0.0)) return std::nullopt;
  const Place p{
      {m[0] / sum, m[1] / sum}, m[2] / sum - m[0] * m[0] / (sum * sum), m[3] / sum - m[0] * m[1] / (sum * sum), m[4] / sum - m[1] * m[1] / (sum * sum)};
  constexpr double kHalf = 0.5, kMostSpread = 0.25;  // of a subpixel
  const bool good = std::abs(p.middle.x) <= kHalf && std::abs(p.middle.y) <= kHalf && p.xx >= 0.0 && p.yy >= 0.0 && p.xx <= kMostSpread &&
                    p.yy <= kMostSpread && p.xy * p.xy <= p.xx * p.yy * (1.0 + 1e-9);
  return good ? std::optional(p) : std::nullopt;
}

std::vector<glm::dvec2> pointsOf(const Place& p) {
  // Principal axes of the spread; two points along each, root 2 of its deviation off, have the same.
  const double mean = 0.5 * (p.xx + p.yy), off = std::sqrt(0.25 * (p.xx - p.yy) * (p.xx - p.yy) + p.xy * p.xy),
               angle = 0.5 * std::atan2(2.0 * p.xy, p.xx - p.yy);
  constexpr double kNoSpread = 1e-3;  // of a subpixel squared
  if (mean + off < kNoSpread) return {glm::dvec2(0.0)};
  const glm::dvec2 along = std::sqrt(2.0 * std::max(mean + off, 0.0)) * glm::dvec2(std::cos(angle), std::sin(angle)),
                   across = std::sqrt(2.0 * std::max(mean - off, 0.0)) * glm::dvec2(-std::sin(angle), std::cos(angle));
  return {along, -along, across, -across};
}

}  // namespace pitviper
