#pragma once
// The air along a line of sight in sunlight: what every wavelength needs of its geometry, worked out once.
#include <optional>

#include "sim/world/sun_legs.hpp"

namespace pitviper {

/// The sun as seen from the beginning of a ray.
struct RaySun {
  double sinElevation = 0.0;
  double cosScatter = 0.0;  ///< of the angle between the ray and the direction to the sun
};

/// Cosine of the azimuth between a ray and the sun; 0 where one of them has none.
double cosAzimuthOf(double sinElevation, const RaySun& sun);

struct SunlitAir {
  std::vector<AirStation> stations;
  std::vector<AirAmounts> powered;  ///< of each station, from the camera
  std::vector<AirAmounts> both;     ///< with the way on to the sun
  std::vector<double> lit;          ///< share of the sun's disc that stands above its horizon; empty: no sun
  std::vector<double> sine;         ///< of the line's elevation at each station
  double cosScatter = 0.0;          ///< as RaySun
  double cosAzimuth = 0.0;          ///< of the ray's azimuth to the sun's

  SunlitAir(const Atmosphere& path, const AirRay& ray, std::vector<AirStation> stations, const SunLegs* legs, const RaySun& sun);
};

}  // namespace pitviper
