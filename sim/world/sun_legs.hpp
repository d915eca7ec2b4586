#pragma once
// What lies between places of layered air and the sun, by height: tabulated once where asked, for every place that sunlight reaches.
#include <memory>
#include <mutex>
#include <vector>

#include "sim/model/atmosphere.hpp"
#include "sim/model/refracts.hpp"

namespace pitviper {

/// The part of the sun's disc that stands above a place's own horizon, and its middle (sim/radiometry/glsl/sun_disc.glsl).
struct RisenSun {
  double share = 1.0;         ///< of the disc; 0: behind the earth
  double sinElevation = 0.0;  ///< of its middle: that of the sun's centre where all of it is up
};
RisenSun risenSun(double height_m, double sinElevation, double earthRadius_m);

/// Sine of the sun's elevation below which no air sees it any more.
constexpr double kNight = -0.35;

class SunLegs {
 public:
  /// For sun elevations around one: sines from 0.02 below it to 0.025 above (130 km around the origin, and a disc on the horizon), more of a high
  /// sun; others are worked out in full.
  SunLegs(std::shared_ptr<const Atmosphere> path, double sinElevation, double earthRadius_m);
  /// The same once for all who ask while somebody keeps it.
  static std::shared_ptr<const SunLegs> of(const std::shared_ptr<const Atmosphere>& path, double sinElevation, double earthRadius_m);
  /// Towards a sun above the place's horizon. Optical depths of haze within 1e-3 but for some metres below where a haze ends, there within 0.02 of 10
  /// (visibilities from 10 km; tests/physics/test_low_sun.cpp).
  AirAmounts at(double height_m, double sinElevation) const;

  /// The table, without shells, as the shader reads it too (atmosphere/layered.glsl): roots of the amounts above a height towards elevations from 0 on, cubic
  /// between elevations, linear between heights: a column of what ends at a height falls to nothing as a square, and elsewhere a root bends less than the
  /// column. A line that goes down first has twice what lies above its lowest point, less what lies behind it.
  static constexpr int kHeights = 1024, kElevations = 14;
  /// The deepest open ground is 0.43 km below the sea.
  static constexpr double kBottom_m = -500.0;
  /// Entry of a height: closer together near the ground, a step of 14 m there, 60 m at 10 km.
  static double heightAt(double entry, double top_m);
  double firstSine() const { return first_; }
  double step() const { return step_; }
  const AirAmounts& rootAt(int elevation, int height) const { return rowAt(height)[elevation]; }
  /// All of the table on all cores, before every entry is asked for.
  void fill() const;
  double earthRadius_m() const { return radius_m_; }

 private:
  bool has(double height_m, double sine) const;
  AirAmounts upwards(double height_m, double sine) const;
  /// Of a line that goes down first.
  double lowestOn(double height_m, double sine) const;
  /// By elevation; made when first asked for.
  const AirAmounts* rowAt(int height) const;
  std::shared_ptr<const Atmosphere> path_;
  double step_, first_, radius_m_, top_m_;
  mutable std::vector<AirAmounts> roots_;  ///< [height][elevation]
  mutable std::vector<std::once_flag> made_;
  const Refracts* bends_;  ///< of the path; null: its lines are straight
};

}  // namespace pitviper
