#include "scenarios/commands/charts/trajectory_view.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Looked down at by so much: floor and heights both show.
constexpr double kElevation_rad = 26.0 * kPi / 180.0;
/// No side is seen nearer to edge-on than this.
constexpr double kLeastTurn_deg = 25.0;
/// A floor narrower than this part of its length is widened: it would be a line.
constexpr double kNarrowest = 0.25;
/// Flatter boxes have their heights exaggerated.
constexpr double kFlattest = 0.1;
/// The floor is at height 0 where the box is then no higher than so many times its longer side, or hardly higher than the paths are.
constexpr double kHighest = 1.0;

/// 1, 2, 5, 10 ... not below.
double roundUp(double x) {
  const double decade = std::pow(10.0, std::floor(std::log10(x)));
  for (const double f : {1.0, 2.0, 5.0})
    if (f * decade >= x * (1.0 - 1e-9)) return f * decade;
  return 10.0 * decade;
}

}  // namespace

TrajectoryView::TrajectoryView(const std::vector<glm::dvec3>& places, const PictureArea& area) {
  low_ = high_ = places.front();
  for (const glm::dvec3& p : places) low_ = glm::min(low_, p), high_ = glm::max(high_, p);
  glm::dvec3 size = high_ - low_;
  const double longest = std::max({size.x, size.y, 1e-3 * size.z, 1e-3});
  constexpr double kAir = 0.04;  // around the paths, of the longer side
  for (int i = 0; i < 2; ++i) {
    const double wanted = std::max(size[i], std::max(kNarrowest * longest, kNarrowest * size.z)) + 2.0 * kAir * longest, more = 0.5 * (wanted - size[i]);
    low_[i] -= more, high_[i] += more;
  }
  size = high_ - low_;
  const double across = std::max(size.x, size.y);
  // Heights: from the ground where that does not squeeze the paths, else from a round height below them.
  const double tall = size.z;
  const bool isNear = high_.z <= kHighest * across && tall >= 0.15 * high_.z, isLow = low_.z <= 0.25 * tall;
  if (low_.z >= 0.0 && (isNear || isLow)) low_.z = 0.0;
  else {
    const double round = roundUp(std::max(0.25 * std::max(tall, 0.02 * across), 1e-6));
    low_.z = std::floor((low_.z - 0.02 * across) / round) * round;
    if (high_.z >= 0.0 && low_.z < 0.0 && -low_.z < 0.1 * across && high_.z - tall >= 0.0) low_.z = 0.0;
  }
  high_.z += 0.08 * std::max(high_.z - low_.z, 0.02 * across);
  const double ratio = (high_.z - low_.z) / across;
  exaggeration_ = ratio < kFlattest ? roundUp(2.0 * kFlattest / ratio) : 1.0;
  middle_ = 0.5 * (low_ + high_);

  // From where the paths spread most over the picture; from the south where that costs little, as maps are read.
  double best = -1.0, bestAzimuth = 0.0;
  for (double azimuth_deg = 0.0; azimuth_deg < 360.0; azimuth_deg += 5.0) {
    const double off = std::fmod(azimuth_deg, 90.0);
    if (off < kLeastTurn_deg || off > 90.0 - kLeastTurn_deg) continue;
    turn(azimuth_deg * kPi / 180.0);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const glm::dvec3& p : places) {
      const glm::dvec3 d = (p - middle_) * glm::dvec3(1.0, 1.0, exaggeration_);
      const double x = glm::dot(d, right_), y = glm::dot(d, up_);
      xx += x * x, xy += x * y, yy += y * y;
    }
    constexpr double kFromSouth = 1.5;
    const double spread = (xx * yy - xy * xy + 1e-6 * xx * xx) * (back_.y < 0.0 ? kFromSouth : 1.0);
    if (spread > best) best = spread, bestAzimuth = azimuth_deg * kPi / 180.0;
  }
  turn(bestAzimuth);
  glm::dvec2 least(INFINITY), most(-INFINITY);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec2 at = projected(drawn(atCorner(i & 1, i & 2, i & 4)));
    least = glm::min(least, at), most = glm::max(most, at);
  }
  pixelsPer_m_ = std::min(area.width / (most.x - least.x), area.height / (most.y - least.y));
  // The box is symmetric about its middle, and so is its outline.
  origin_ = {area.left + 0.5 * area.width, area.top + 0.5 * area.height};
  reach_ = glm::length(drawn(high_)) + 100.0;
}

void TrajectoryView::turn(double azimuth_rad) {
  const double c = std::cos(kElevation_rad), s = std::sin(kElevation_rad);
  back_ = {c * std::sin(azimuth_rad), c * std::cos(azimuth_rad), s};
  right_ = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), back_));
  up_ = glm::cross(back_, right_);
}

glm::dvec3 TrajectoryView::drawn(const glm::dvec3& place_m) const { return (place_m - middle_) * glm::dvec3(1.0, 1.0, exaggeration_) * pixelsPer_m_; }

glm::dvec3 TrajectoryView::inFront(const glm::dvec2& p) const { return right_ * (p.x - origin_.x) - up_ * (p.y - origin_.y) + back_ * reach_; }

}  // namespace pitviper
