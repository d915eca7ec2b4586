#pragma once
// What lies between places of layered air and the sun, by height: tabulated once, asked for every place that sunlight reaches.
#include <vector>

#include "sim/model/path.hpp"

namespace pitviper {

/// The part of the sun's disc that stands above a place's own horizon, and its middle (sim/radiometry/glsl/sun_disc.glsl).
struct RisenSun {
  double share = 1.0;         ///< of the disc; 0: behind the earth
  double sinElevation = 0.0;  ///< of its middle: that of the sun's centre where all of it is up
};
RisenSun risenSun(double height_m, double sinElevation, double earthRadius_m);

class SunLegs {
 public:
  /// For sun elevations around one: sines from 0.02 below it to 0.025 above (130 km around the origin, and a disc on the horizon), more of a high
  /// sun; others are worked out in full.
  SunLegs(const Path& path, double sinElevation, double earthRadius_m);
  /// Towards a sun above the place's horizon. Relative error of amounts below 3e-3 up to 3 km (1e-3 with the sun 2 degrees up), above 4e-3, of water 5 %
  /// (tests/physics/test_low_sun.cpp).
  AirAmounts at(double height_m, double sinElevation) const;

  /// The table, as the shader reads it too (atmosphere/layered.glsl): ln of amounts, cubic between elevations, linear between heights.
  static constexpr int kHeights = 128, kElevations = 10;
  /// The deepest open ground is 0.43 km below the sea.
  static constexpr double kBottom_m = -500.0;
  /// Entry of a height: closer together near the ground, a step of 100 m there, 0.5 km at 10 km.
  static double heightAt(double entry, double top_m);
  double firstSine() const { return first_; }
  double step() const { return step_; }
  const AirAmounts& logAt(int elevation, int height) const { return logs_[static_cast<size_t>(elevation * kHeights + height)]; }
  double earthRadius_m() const { return radius_m_; }

 private:
  const Path& path_;
  double step_, first_, radius_m_, top_m_;
  std::vector<AirAmounts> logs_;  ///< [elevation][height]
};

}  // namespace pitviper
