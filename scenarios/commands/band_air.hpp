#pragma once
// A scenario's air as a channel sees a small difference of temperature through it.
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

class BandAir {
 public:
  /// From a scenario's first camera along its line of sight, at its first frame. `background_K`: the temperature from which the difference is. Errors:
  /// UserError for a scenario without cameras, and for air without data where the channel responds.
  BandAir(const Simulation& scenario, ChannelOutput output, double background_K);

  /// Mean transmittance, weighted by the channel's kernel and by dB/dT: what is left of a small difference.
  double at(double range_m) const;
  double height_m() const { return ray_.height_m; }
  double elevation_rad() const;

 private:
  std::shared_ptr<const Atmosphere> air_;
  AirRay ray_;
  std::vector<double> weights_;  ///< adding up to 1
  std::vector<AirNode> nodes_;
};

}  // namespace pitviper
