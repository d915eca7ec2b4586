#pragma once
// The groups of wavelengths of all channels of a plan: fitted to lines of sight as sums of products, then held against the radiance equation itself,
// which products are simpler than.
#include <functional>
#include <memory>
#include <vector>

#include "sim/plan/channel_fit.hpp"
#include "sim/plan/line_check.hpp"

namespace pitviper {

/// Lines of sight, and what each slot is off by on them.
struct CheckedLines {
  std::vector<SightRay> lines;
  std::vector<LineFigures> figures;
  /// More of them; medians stay those of the first.
  void add(const std::vector<SightRay>& more, const std::vector<LineFigures>& theirs);
};

class PlanFits {
 public:
  /// Fits groups within plan.accuracy. `slots`: an output of each; `fine`: the plan of every wavelength; `floor`: filmFloors();
  /// `airPlaces`: airPlacesFor() it; `tell`: what part of the work of the constructor or of learn() is done, at most. All must outlive it.
  PlanFits(const Simulation& simulation, const Eye& eye, const Plan& plan, const std::vector<const ChannelOutput*>& slots, const NodesOfPlan& fine,
           SightRays& rays, const std::vector<double>& floor, int airPlaces, const std::function<void(double part)>& tell);
  /// Fits those slots to what they are off by on these lines besides.
  void learn(const CheckedLines& checked, const std::vector<size_t>& slots);
  /// The groups as the plan's nodes.
  void takeNodes(Plan& plan) const;

 private:
  void hold(std::vector<size_t> open);
  void teach(const CheckedLines& checked, const std::vector<size_t>& slots);

  const Simulation& sim_;
  const NodesOfPlan& fine_;
  SightRays& rays_;
  const std::vector<double>& floor_;
  int airPlaces_;
  const std::function<void(double)>& tell_;
  Plan plan_;
  Sights sights_;
  std::vector<std::unique_ptr<ChannelFit>> fits_;
  CheckedLines second_;  ///< what fits are held against
};

}  // namespace pitviper
