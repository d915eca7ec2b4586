#pragma once
// The air along a line of sight, at the places at which it is looked at.
#include <vector>

#include "sim/radiance/radiance.hpp"

namespace pitviper {

class AirPlaces {
 public:
  /// `ranges_m`: places that must be among them, rising, from 0 on.
  AirPlaces(const RadianceScene& scene, const LineOfSight& line, std::vector<double> ranges_m);
  const std::vector<AirPlace>& places() const { return places_; }
  bool sunlit() const { return sunlit_; }
  double cosScatter() const { return cosScatter_; }
  double cosAzimuth() const { return cosAzimuth_; }
  /// From the eye to a place, not raised to their powers.
  const AirAmounts& amounts(const AirPlace& place) const { return amounts_[static_cast<size_t>(&place - places_.data())]; }

 private:
  std::vector<AirPlace> places_;
  std::vector<AirAmounts> amounts_;
  bool sunlit_ = false;
  double cosScatter_ = 0.0, cosAzimuth_ = 0.0;
};

}  // namespace pitviper
