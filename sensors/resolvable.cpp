#include "sensors/resolvable.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

double sinc(double x) { return std::abs(x) < 1e-9 ? 1.0 : std::sin(kPi * x) / (kPi * x); }

/// Share of a pixel's variance that is left in a mean over a length, as the display shows pixels.
double left(double pitch, double length) { return pitch <= length ? pitch / length * (1.0 - pitch / (3.0 * length)) : 1.0 - length / (3.0 * pitch); }

}  // namespace

double eyeThreshold(double u, double field_deg, double luminance) {
  const double spread = std::exp(-0.0016 * u * u * std::pow(1.0 + 100.0 / luminance, 0.08));
  const double area = 1.0 + 144.0 / (field_deg * field_deg) + 0.64 * u * u, noise = 63.0 / std::pow(luminance, 0.83) + 1.0 / -std::expm1(-0.02 * u * u);
  return std::sqrt(area * noise) / (5200.0 * spread);
}

namespace {

/// Where an eye needs least contrast [1/deg].
double bestFrequency(double field_deg, double luminance) {
  double low = 0.0, high = 12.0;  // it lies at 1 to 8 cycles a degree for any display
  for (int k = 0; k < 24; ++k) {  // thirds: 12 (2/3)^24 = 7e-4
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    if (eyeThreshold(a, field_deg, luminance) < eyeThreshold(b, field_deg, luminance)) high = b;
    else low = a;
  }
  return 0.5 * (low + high);
}

}  // namespace

double nyquist_per_rad(const Resolving& c, Bars bars) { return 0.5 / (bars == Bars::SideBySide ? c.pitchX_rad : c.pitchY_rad); }

Mrtd::Mrtd(const Resolving& camera, Bars bars) : c_(camera), bars_(bars) {
  const Observer& o = c_.observer;
  const double height_rad = 2.0 * std::atan(0.5 * o.displayHeight_m / o.distance_m), degree = kPi / 180.0;
  field_deg_ = height_rad / degree;
  cyclesPerDegree_ = c_.rows * c_.pitchY_rad / height_rad * degree;
  best_ = bestFrequency(field_deg_, o.luminance_cd_m2);
}

double Mrtd::operator()(double f) const {
  const Resolving& c = c_;
  if (f > nyquist_per_rad(c, bars_) * (1.0 + 1e-12)) return INFINITY;
  const bool across = bars_ == Bars::SideBySide;
  const double own = across ? c.pitchX_rad : c.pitchY_rad, other = across ? c.pitchY_rad : c.pitchX_rad;
  const double passed = std::abs(c.transfer(f)) * sinc(own * f);
  if (!(passed > 0.0)) return INFINITY;
  const Observer& o = c.observer;
  const auto square = [](double x) { return x * x; };
  const double time = std::min(1.0, 1.0 / (c.rate_Hz * o.eye_s)), a = left(own, 0.5 / f), b = left(other, 3.5 / f);
  const double alternating = across ? c.noise.th : c.noise.tv, fixed = across ? c.noise.h : c.noise.v;
  const double variance = square(c.noise.tvh) * time * a * b + square(c.noise.vh) * a * b + square(alternating) * time * a + square(fixed) * a;
  const double noise = kPi * kPi / 8.0 * o.snr * std::sqrt(variance) / passed;
  if (!(o.sceneContrast_K > 0.0)) return noise;
  // An observer may step back: bars that are too coarse for the eye are seen as finer ones.
  const double threshold = eyeThreshold(std::max(f * cyclesPerDegree_, best_), field_deg_, o.luminance_cd_m2);
  return std::hypot(noise, 0.25 * kPi * 2.0 * o.sceneContrast_K * threshold / passed);
}

double mrtd_K(const Resolving& c, Bars bars, double f) { return Mrtd(c, bars)(f); }

namespace {

/// Of one direction: as far as all lower frequencies are resolved too, for a lens may lose some and let higher ones through.
double resolvedBy(const Resolving& c, Bars bars, double difference_K) {
  constexpr int kSteps = 400;
  const double most = nyquist_per_rad(c, bars);
  const Mrtd mrtd(c, bars);
  for (int k = 0; k < kSteps; ++k) {
    double low = most * k / kSteps, high = most * (k + 1) / kSteps;
    if (mrtd(high) <= difference_K) continue;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (mrtd(middle) <= difference_K ? low : high) = middle;
    }
    return low > 1e-9 * most ? low : 0.0;  // of halves of the first step nothing else is left where none is resolved
  }
  return most;
}

}  // namespace

double resolved_per_rad(const Resolving& c, double difference_K) {
  return std::sqrt(resolvedBy(c, Bars::SideBySide, difference_K) * resolvedBy(c, Bars::Stacked, difference_K));
}

}  // namespace pitviper
