#include "scenarios/commands/band_air.hpp"

#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/world/coverage.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

BandAir::BandAir(const Simulation& scenario, ChannelOutput output, double background_K) : air_(scenario.air) {
  if (scenario.cameras.empty())
    throw UserError({scenario.name, 0, 0, -1}, "a scenario without a camera", "one, along whose line of sight the air is looked through",
                    "add 'cameras' to it");
  const Pose pose = cameraAt(scenario.cameras.front(), advance(scenario, scenario.time.at(0))).pose;
  ray_ = {scenario.frame.height(pose.position), glm::dot(pose.orientation * glm::dvec3(1, 0, 0), scenario.frame.up(pose.position)),
          scenario.frame.earthRadius_m()};
  if (!air_ || !air_->traits().any) return;
  Simulation alone;
  alone.air = air_;
  cutToData(alone, output);
  // Even in wavenumber, closer than the 5 1/cm of library air and tape7s for any band of a camera.
  constexpr int kPoints = 3000;
  const double low = std::max(output.bandLow_um, air_->validLow_um()), high = std::min(output.bandHigh_um, air_->validHigh_um());
  double all = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const double wavenumber = 1.0 / high + (1.0 / low - 1.0 / high) * (k + 0.5) / kPoints, um = 1.0 / wavenumber, step = 1e-3 * background_K;
    const double weight = output.kernel(um) * (physics::planckRadiance(um, background_K + step) - physics::planckRadiance(um, background_K - step)) * um *
                          um;  // d lambda = lambda^2 d nu
    if (!(weight > 0.0)) continue;
    weights_.push_back(weight);
    nodes_.push_back(air_->node(um));
    all += weight;
  }
  for (double& w : weights_) w /= all;
}

double BandAir::at(double range_m) const {
  if (nodes_.empty()) return 1.0;
  const AirAmounts powered = air_->powered(air_->amounts(ray_, range_m));
  double sum = 0.0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) sum += weights_[k] * std::exp(-Atmosphere::depthOf(nodes_[k], powered));
  return sum;
}

double BandAir::elevation_rad() const { return std::asin(std::clamp(ray_.sinElevation, -1.0, 1.0)); }

}  // namespace pitviper
