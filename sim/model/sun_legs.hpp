#pragma once
// What lies between places of layered air and the sun, by height: tabulated once, asked for every place that sunlight reaches.
#include <vector>

#include "sim/model/path.hpp"

namespace pitviper {

class SunLegs {
 public:
  /// Sun elevations whose sine lies within 0.02 of this one (130 km around the origin); others are worked out in full.
  SunLegs(const Path& path, double sinElevation, double earthRadius_m);
  /// Relative error of amounts below 1e-4 up to 30 km (tests/unit/test_air.cpp).
  AirAmounts at(double height_m, double sinElevation) const;
  /// The earth, a sphere, is in between.
  bool inShadow(double height_m, double sinElevation) const;

 private:
  static constexpr int kHeights = 128, kElevations = 3;
  static constexpr double kSpan = 0.02;
  double heightAt(int entry) const;
  const Path& path_;
  double sinLow_, radius_m_, bottom_m_, top_m_;
  std::vector<AirAmounts> logs_;  ///< ln of amounts, [elevation][height]
};

}  // namespace pitviper
