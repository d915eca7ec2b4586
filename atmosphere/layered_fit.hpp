#pragma once
// How many entries tables of layered air need: what they lose on lines of sight, and the size that keeps it within an accuracy.
#include <vector>

#include "atmosphere/layered_rows.hpp"
#include "sim/plan/air_table_request.hpp"
#include "sim/plan/line_check.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {

/// What tables of a size lose in the middle between their entries, at most over lines of sight; relative to the pixel, per slot.
struct AirTableLoss {
  std::vector<double> elevations, ranges, azimuths;
  std::vector<double> shared;  ///< by views that share tables
  std::vector<double> sums;    ///< of a line, at most
};

/// The same, or less where that would take more memory than tables may: fewer azimuths, then ranges and elevations.
AirTableSize affordable(AirTableSize size, const Simulation& simulation, const Plan& plan);

/// As of Atmosphere::planTables().
std::vector<double> planLayeredTables(const AirTableRequest& request);

/// Lines of sight of a camera through layered air, each with what lies behind the air.
class AirTableFit {
 public:
  /// Of some of the film's lines and of the extremes. `floor`: what is darker counts as this much, per slot. All must outlive it.
  AirTableFit(const Simulation& simulation, const Camera& camera, const NodesOfPlan& plan, SightRays& rays, const std::vector<double>& floor);
  AirTableLoss lossOf(const AirTableSize& size) const;
  /// The smallest tables found that keep a part of the accuracy, with what they lose. Where even the largest that are affordable don't, these.
  std::pair<AirTableSize, AirTableLoss> within(double accuracy) const;

 private:
  struct Sample {
    std::shared_ptr<const WorldState> state;
    glm::dvec3 origin{0.0}, direction{0.0};
    double range_m = 0.0;          ///< physics::kFar: towards space
    std::vector<double> radiance;  ///< per slot, of air and what is behind it
  };
  struct Lost {
    std::vector<double> elevation, range, azimuth, shared;
  };
  View viewOf(const Sample& sample) const;
  Lost lostOn(const Sample& sample, const AirTableSize& size) const;

  const Simulation& simulation_;
  const Camera& camera_;
  const Plan& plan_;
  AirRows rows_;
  std::vector<Sample> samples_;
  const std::vector<double>& floor_;
  double nearest_m_ = physics::kFar;
};

}  // namespace pitviper
