#include "sim/model/sun_legs.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Stands for no amount at all: 1e-30 of anything has no optical depth.
constexpr double kNothing = 1e-30;
/// The deepest open ground is 0.43 km below the sea.
constexpr double kBottom_m = -500.0;

}  // namespace

SunLegs::SunLegs(const Path& path, double sinElevation, double earthRadius_m)
    : path_(path), sinLow_(std::clamp(sinElevation - kSpan, -1.0, 1.0 - 2.0 * kSpan)), radius_m_(earthRadius_m), bottom_m_(kBottom_m), top_m_(path.top_m()) {
  for (int e = 0; e < kElevations; ++e)
    for (int h = 0; h < kHeights; ++h) {
      AirAmounts a = path.amounts({heightAt(h), sinLow_ + 2.0 * kSpan * e / (kElevations - 1), earthRadius_m}, physics::kFar);
      for (double& w : a.amount) w = std::log(std::max(w, kNothing));
      logs_.push_back(a);
    }
}

// Closer together near the ground: a step of 50 m there, 0.5 km at 10 km.
double SunLegs::heightAt(int entry) const {
  const double t = static_cast<double>(entry) / (kHeights - 1);
  return bottom_m_ + (top_m_ - bottom_m_) * t * t;
}

AirAmounts SunLegs::at(double height_m, double sinElevation) const {
  if (height_m >= top_m_ || height_m < bottom_m_ || sinElevation < sinLow_ || sinElevation > sinLow_ + 2.0 * kSpan)
    return path_.amounts({height_m, sinElevation, radius_m_}, physics::kFar);
  const double t = std::sqrt((height_m - bottom_m_) / (top_m_ - bottom_m_)) * (kHeights - 1);
  const int h = std::min(static_cast<int>(t), kHeights - 2);
  const double y = (sinElevation - sinLow_) / (2.0 * kSpan) * (kElevations - 1);
  const int e = std::min(static_cast<int>(y), kElevations - 2);
  // Linear in height, not in its root: amounts fall off exponentially with height.
  const double fh = (height_m - heightAt(h)) / (heightAt(h + 1) - heightAt(h)), fe = y - e;
  const AirAmounts *low = &logs_[static_cast<size_t>(e * kHeights + h)], *high = low + kHeights;
  AirAmounts a;
  const size_t used = path_.exponents().size();
  for (size_t k = 0; k < used; ++k) {
    const double l = (1 - fe) * ((1 - fh) * low[0].amount[k] + fh * low[1].amount[k]) + fe * ((1 - fh) * high[0].amount[k] + fh * high[1].amount[k]);
    a.amount[k] = std::exp(l);
  }
  return a;
}

bool SunLegs::inShadow(double height_m, double sinElevation) const {
  return sinElevation < 0.0 && (radius_m_ + height_m) * std::sqrt(1.0 - sinElevation * sinElevation) < radius_m_;
}

}  // namespace pitviper
