#include "sim/model/sun_legs.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Stands for no amount at all: 1e-30 of anything has no optical depth.
constexpr double kNothing = 1e-30;
/// Steps of sine on the horizon, where ln of the air mass bends most (scale of its sine: 1/38), and their growth with the sun's height.
constexpr double kStep = 0.005, kGrowth = 10.0;
/// Entries below the sun's own sine.
constexpr int kBelow = 4;

}  // namespace

RisenSun risenSun(double height_m, double sinElevation, double earthRadius_m) {
  const double x = physics::sunAboveHorizon(height_m, sinElevation, earthRadius_m);
  return {physics::sunShare(x),
          std::min(sinElevation + physics::sunRise(x) * physics::sunRadius() * std::sqrt(std::max(1.0 - sinElevation * sinElevation, 0.0)), 1.0)};
}

SunLegs::SunLegs(const Path& path, double sinElevation, double earthRadius_m)
    : path_(path),
      step_(kStep * (1.0 + kGrowth * std::max(sinElevation, 0.0))),
      first_(std::clamp(sinElevation - kBelow * step_, -1.0, 1.0 - (kElevations - 1) * step_)),
      radius_m_(earthRadius_m),
      top_m_(path.top_m()) {
  for (int e = 0; e < kElevations; ++e)
    for (int h = 0; h < kHeights; ++h) {
      AirAmounts a = path.amounts({heightAt(h, top_m_), first_ + step_ * e, earthRadius_m}, physics::kFar);
      for (double& w : a.amount) w = std::log(std::max(w, kNothing));
      logs_.push_back(a);
    }
}

double SunLegs::heightAt(double entry, double top_m) {
  const double t = entry / (kHeights - 1);
  return kBottom_m + (top_m - kBottom_m) * t * t;
}

AirAmounts SunLegs::at(double height_m, double sinElevation) const {
  const double x = (sinElevation - first_) / step_;
  if (height_m >= top_m_ || height_m < kBottom_m || !(x >= 0.0 && x <= kElevations - 1))
    return path_.amounts({height_m, sinElevation, radius_m_}, physics::kFar);
  const double t = std::sqrt((height_m - kBottom_m) / (top_m_ - kBottom_m)) * (kHeights - 1);
  const int h = std::min(static_cast<int>(t), kHeights - 2), e = std::clamp(static_cast<int>(x) - 1, 0, kElevations - 4);
  // Linear in height, not in its root: amounts fall off exponentially with height.
  const double low = heightAt(h, top_m_), high = (height_m - low) / (heightAt(h + 1, top_m_) - low), f = x - e;
  // Lagrange's cubic through four entries.
  const double weight[] = {(f - 1) * (f - 2) * (3 - f) / 6, f * (f - 2) * (f - 3) / 2, f * (f - 1) * (3 - f) / 2, f * (f - 1) * (f - 2) / 6};
  AirAmounts a;
  const size_t used = path_.exponents().size();
  for (size_t k = 0; k < used; ++k) {
    double l = 0.0;
    for (int j = 0; j < 4; ++j) l += weight[j] * ((1 - high) * logAt(e + j, h).amount[k] + high * logAt(e + j, h + 1).amount[k]);
    a.amount[k] = std::exp(l);
  }
  return a;
}

}  // namespace pitviper
