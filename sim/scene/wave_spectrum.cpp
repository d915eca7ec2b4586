#include "sim/scene/wave_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Spreading: of waves at the peak 4, without wind ln(2) / 4, of the slowest ones 0.13 u* / c_m.
constexpr double kSpreadRest = 0.17328679513998632, kSpreadPeak = 4.0, kSpreadSlowest = 0.13;

}  // namespace

double waveFrequency_rad_s(double k) {
  const double x = k / kSlowestWave_rad_m;
  return std::sqrt(kWaveGravity_m_s2 * k * (1.0 + x * x));
}

double phaseSpeed_m_s(double k) {
  const double x = k / kSlowestWave_rad_m;
  return std::sqrt(kWaveGravity_m_s2 / k * (1.0 + x * x));
}

WaveSpectrum::WaveSpectrum(double wind10_m_s, double inverseWaveAge) : age_(inverseWaveAge) {
  if (!(wind10_m_s >= 0.0 && wind10_m_s <= 40.0)) throw std::invalid_argument("waves need a wind of 0 to 40 m/s");
  if (!(age_ >= 0.84 && age_ <= 5.0)) throw std::invalid_argument("an inverse wave age lies between 0.84 and 5");
  if (wind10_m_s == 0.0) return;
  const double u2 = wind10_m_s * wind10_m_s;
  friction_m_s_ = 0.4 * wind10_m_s / std::log(10.0 / (3.7e-5 * u2 / kWaveGravity_m_s2 * std::pow(age_, 0.9)));
  peak_rad_m_ = kWaveGravity_m_s2 / u2 * age_ * age_;
  peakSpeed_m_s_ = wind10_m_s / age_;
  longPart_ = 0.5 * 6e-3 * std::sqrt(age_);
  const double ratio = std::log(friction_m_s_ / kSlowestSpeed_m_s);
  // Without enough wind to raise them there are none.
  shortPart_ = 0.5 * std::max(0.0, 1e-2 * (1.0 + (ratio > 0.0 ? 3.0 : 1.0) * ratio));
  enhanced_ = age_ > 1.0 ? 1.7 + 6.0 * std::log10(age_) : 1.7;
  width_ = 0.08 * (1.0 + 4.0 / (age_ * age_ * age_));
}

double WaveSpectrum::inverseWaveAgeOf(double wind10_m_s, double fetch_m) {
  if (!(wind10_m_s > 0.0 && fetch_m > 0.0)) throw std::invalid_argument("a wave age needs wind and fetch");
  return std::min(5.0, 0.84 * std::pow(std::tanh(std::pow(fetch_m * kWaveGravity_m_s2 / (2.2e4 * wind10_m_s * wind10_m_s), 0.4)), -0.75));
}

double WaveSpectrum::curvature(double k) const {
  if (!(k > 0.0) || peak_rad_m_ == 0.0) return 0.0;
  const double r = k / peak_rad_m_, root = std::sqrt(r) - 1.0, x = k / kSlowestWave_rad_m - 1.0, c = phaseSpeed_m_s(k);
  const double peak = std::exp(-1.25 / (r * r)) * std::pow(enhanced_, std::exp(-root * root / (2.0 * width_ * width_)));
  return peak * (longPart_ * peakSpeed_m_s_ / c * std::exp(-age_ / std::sqrt(10.0) * root) + shortPart_ * kSlowestSpeed_m_s / c * std::exp(-0.25 * x * x));
}

double WaveSpectrum::omnidirectional(double k) const { return k > 0.0 ? curvature(k) / (k * k * k) : 0.0; }

double WaveSpectrum::spread(double k) const {
  if (!(k > 0.0) || peak_rad_m_ == 0.0) return 0.0;
  const double c = phaseSpeed_m_s(k);
  return std::tanh(kSpreadRest + kSpreadPeak * std::pow(c / peakSpeed_m_s_, 2.5) +
                   kSpreadSlowest * friction_m_s_ / kSlowestSpeed_m_s * std::pow(kSlowestSpeed_m_s / c, 2.5));
}

double WaveSpectrum::directional(double k, double phi) const {
  return k > 0.0 ? omnidirectional(k) * (1.0 + spread(k) * std::cos(2.0 * phi)) / (2.0 * kPi * k) : 0.0;
}

WaveMoments WaveSpectrum::moments(double low, double high) const {
  WaveMoments sum;
  if (peak_rad_m_ == 0.0) return sum;
  // Below a tenth of the peak exp(-125) is left. Three Gauss points to steps of 2 % in k.
  const double from = std::log(std::max(low, 0.1 * peak_rad_m_)), to = std::log(std::min(high, kShortest_rad_m));
  if (!(to > from)) return sum;
  constexpr double kStep = 0.02, kPoint = 0.38729833462074169;
  const int steps = static_cast<int>(std::ceil((to - from) / kStep));
  const double step = (to - from) / steps;
  for (int i = 0; i < steps; ++i)
    for (int j = -1; j <= 1; ++j) {
      const double k = std::exp(from + step * (i + 0.5 + j * kPoint)), weight = step * (j == 0 ? 8.0 : 5.0) / 18.0;
      // S dk = B / k^2 dln k, k^2 S dk = B dln k; means of cos^2 and sin^2 over directions.
      const double b = curvature(k) * weight, half = 0.5 * spread(k);
      sum.height_m2 += b / (k * k);
      sum.slopeUp += 0.5 * (1.0 + half) * b;
      sum.slopeCross += 0.5 * (1.0 - half) * b;
    }
  return sum;
}

double WaveSpectrum::significantHeight_m() const { return 4.0 * std::sqrt(moments().height_m2); }

WaveMoments coxMunkSlopes(double wind12_m_s) { return {0.0, 3.16e-3 * wind12_m_s, 0.003 + 1.92e-3 * wind12_m_s}; }

}  // namespace pitviper
