#pragma once
// The groups of wavelengths of all channels of a plan, those of alike kernels in common: fitted to lines of sight as sums of products, then held against the
// radiance equation itself, which products are simpler than.
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
  void add(const std::vector<SightRay>& more, const std::vector<LineFigures>& theirs);
  void addSome(const std::vector<SightRay>& more, const std::vector<LineFigures>& theirs, const std::function<bool(const SightRay&)>& wanted);
};

class PlanFits {
 public:
  /// Fits groups within plan.accuracy. `slots`: an output of each; `fine`: the plan of every wavelength; `extremes`: those of the rays; `floor`: filmFloors();
  /// `airPlaces`: airPlacesFor() fits, `lastPlaces`: for what they are held against; `tell`: what part of the work of the constructor or of learn() is done, at
  /// most. All must outlive it.
  PlanFits(const Simulation& simulation, const Eye& eye, const Plan& plan, const std::vector<const ChannelOutput*>& slots, const NodesOfPlan& fine,
           HeldLines& extremes, SightRays& rays, const std::vector<double>& floor, int airPlaces, int lastPlaces, const std::function<void(double part)>& tell);
  /// Adds what these slots are off by on these lines to what their fits learn. `allowed`: the most that each slot may be off by. Returns the slots whose groups
  /// have changed, with those of the same fits.
  std::vector<size_t> learn(const CheckedLines& checked, const std::vector<size_t>& slots, const std::vector<double>& allowed);
  /// From here on fits look at the air in as many places as they are held against.
  void lookCloser() { sights_.setAirPlaces(lastPlaces_); }
  /// The groups as the plan's nodes.
  void takeNodes(Plan& plan) const;

 private:
  void hold(const std::vector<size_t>& fits);
  void teach(const CheckedLines& checked, const std::vector<size_t>& fits, const std::vector<double>& allowed);

  const Simulation& sim_;
  const NodesOfPlan& fine_;
  SightRays& rays_;
  const std::vector<double>& floor_;
  int lastPlaces_;
  const std::function<void(double)>& tell_;
  Plan plan_;
  std::vector<std::vector<size_t>> slots_;  ///< of each fit
  Sights sights_;
  std::vector<std::unique_ptr<ChannelFit>> fits_;
  HeldLines& extremes_;
  HeldLines second_;  ///< what fits are held against besides
};

}  // namespace pitviper
