#include "sim/model/band_temperature.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

constexpr double kColdest_K = 20.0, kHottest_K = 20000.0;
constexpr int kEntries = 700;  // 1 % apart

}  // namespace

BandTemperature::BandTemperature(const Spectrum& kernel, double low_um, double high_um) {
  for (int k = 0; k < kEntries; ++k) {
    const double kelvin = kColdest_K * std::pow(kHottest_K / kColdest_K, k / (kEntries - 1.0));
    const double value = (kernel * Spectrum(Spectrum::BlackBody{kelvin, 1.0})).integral(low_um, high_um);
    if (!(value > 0.0)) continue;  // short waves of cold bodies
    inverse_.push_back(1.0 / kelvin);
    log_.push_back(std::log(value));
  }
}

double BandTemperature::operator()(double integral) const {
  if (!(integral > 0.0) || log_.size() < 2 || std::log(integral) < log_.front()) return 0.0;
  const double x = std::log(integral);
  if (x >= log_.back()) return kHottest_K;
  const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(log_.begin(), log_.end(), x) - log_.begin(), 1, static_cast<std::ptrdiff_t>(log_.size()) - 1);
  const auto k = static_cast<std::size_t>(above);
  return 1.0 / (inverse_[k - 1] + (inverse_[k] - inverse_[k - 1]) * (x - log_[k - 1]) / (log_[k] - log_[k - 1]));
}

double BandTemperature::integral(double temperature_K) const {
  const double x = 1.0 / temperature_K;
  if (log_.size() < 2 || x > inverse_.front()) return 0.0;
  const auto below = std::upper_bound(inverse_.begin(), inverse_.end(), x, [](double a, double b) { return a > b; });
  const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(below - inverse_.begin(), 1, static_cast<std::ptrdiff_t>(inverse_.size()) - 1));
  return std::exp(log_[k - 1] + (log_[k] - log_[k - 1]) * (x - inverse_[k - 1]) / (inverse_[k] - inverse_[k - 1]));
}

double BandTemperature::slope(double temperature_K) const {
  const double step = 1e-3 * temperature_K;
  return (integral(temperature_K + step) - integral(temperature_K - step)) / (2.0 * step);
}

}  // namespace pitviper
