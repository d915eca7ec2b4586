// How layered air bends light.
#include <algorithm>
#include <cmath>

#include "atmosphere/absorber_table.hpp"

namespace pitviper {
namespace {

// Of standard air, to which refractivities are given.
constexpr double kStandard_K = 288.15, kStandard_Pa = 101325.0;
// The radius enters by the gradient of n alone: other latitudes' are within 0.5 %.
constexpr double kEarth_m = 6371000.0;
// Up to here n is followed in steps of 1 km: above, it bends by less than a hundredth of what it does on the ground.
constexpr double kFollowed_m = 20000.0, kStep_m = 1000.0;

}  // namespace

double AbsorberTable::airDensity(double height_m) const {
  const auto found = std::find_if(absorbers_.begin(), absorbers_.end(), [](const Absorber& a) { return a.kind == AbsorberKind::Scattering; });
  return found == absorbers_.end() ? 0.0 : densities(height_m).amount_km[static_cast<size_t>(found - absorbers_.begin())];
}

std::optional<double> AbsorberTable::refractivityPerDensity(double standard) const {
  const double seaLevel = airDensity(0.0);
  if (!(seaLevel > 0.0)) return std::nullopt;
  // A table without laws does not say at which pressure its densities are 1: that of the sea level, as in LOWTRAN's climates within 1 %.
  if (!reference_) return standard * kStandard_K / temperature_K(0.0) / seaLevel;
  return standard * kStandard_K / reference_->temperature_K * reference_->pressure_Pa / kStandard_Pa;
}

std::optional<double> AbsorberTable::refractionCoefficient(double standard, double height_m) const {
  const auto perDensity = refractivityPerDensity(standard);
  if (!perDensity) return std::nullopt;
  return kEarth_m * *perDensity * (airDensity(height_m) - airDensity(height_m + kStep_m)) / kStep_m;
}

void AbsorberTable::addLevels(const std::vector<double>& heights_m) {
  std::vector<double> heights = levels_m();
  for (double h : heights_m)
    if (h > levels_.front().altitude_m && h < top_m() &&
        std::none_of(levels_.begin(), levels_.end(), [&](const Level& l) { return std::abs(l.altitude_m - h) < 1.0; }))
      heights.push_back(h);
  relevel(std::move(heights), [&](double h) {
    Level own;
    own.temperature_K = temperature_K(h);
    own.density = tableDensities(h);
    return own;
  });
}

bool AbsorberTable::setRefraction(double standard, double coefficient) {
  const auto perDensity = refractivityPerDensity(standard);
  if (!perDensity) return false;
  AbsorberTable bent = *this;
  std::vector<double> heights;
  for (double h = kStep_m; h <= kFollowed_m; h += kStep_m) heights.push_back(h);
  bent.addLevels(heights);
  const double ground = *perDensity * airDensity(0.0), scale = 1.0 / ((1.0 + ground) * (1.0 - coefficient));
  for (Level& l : bent.levels_) {
    const double n = *perDensity * airDensity(l.altitude_m);
    l.optical_m = scale * ((n - ground) * kEarth_m + (1.0 + n) * l.altitude_m);
  }
  for (size_t i = 0; i + 1 < bent.levels_.size(); ++i)
    if (!(bent.levels_[i + 1].optical_m > bent.levels_[i].optical_m)) return false;
  bent.stretchAbove_ = 1.0 / scale;
  bent.refracts_ = true;
  *this = std::move(bent);
  return true;
}

double AbsorberTable::stretchOf(size_t interval) const {
  const Level &low = levels_[interval], &high = levels_[interval + 1];
  return (high.altitude_m - low.altitude_m) / (high.optical_m - low.optical_m);
}

double AbsorberTable::opticalOf(double height_m) const {
  if (!refracts_) return height_m;
  if (height_m > top_m()) return levels_.back().optical_m + (height_m - top_m()) / stretchAbove_;
  const size_t i = intervalAt(height_m);
  return levels_[i].optical_m + (height_m - levels_[i].altitude_m) / stretchOf(i);
}

double AbsorberTable::heightOf(double optical_m) const {
  if (!refracts_) return optical_m;
  if (optical_m > levels_.back().optical_m) return top_m() + (optical_m - levels_.back().optical_m) * stretchAbove_;
  const auto above = std::upper_bound(levels_.begin() + 1, levels_.end() - 1, optical_m, [](double x, const Level& l) { return x < l.optical_m; });
  const auto i = static_cast<size_t>(above - levels_.begin()) - 1;
  return levels_[i].altitude_m + (optical_m - levels_[i].optical_m) * stretchOf(i);
}

}  // namespace pitviper
