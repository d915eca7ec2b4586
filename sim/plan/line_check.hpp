#pragma once
// What a plan's wavelengths are off by on lines of sight: its nodes against the fine grid, both summed by the radiance equation in double precision.
#include <span>
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/radiance/node_sum.hpp"

namespace pitviper {

/// Of one channel, relative to max(|L|, floor).
struct LineFigures {
  double largest = 0.0, median = 0.0;
  double dropped = 0.0;        ///< the most that terms make up which the plan leaves out
  std::vector<double> errors;  ///< of each line
  std::vector<double> left;    ///< of each line: what terms make up which the plan leaves out
};

/// A plan with the spectra that lines have in common at its nodes. Both must outlive it.
struct NodesOfPlan {
  NodesOfPlan(const Simulation& simulation, const Plan& of) : plan(of), spectra(simulation, of.nodes, of.terms.surroundings) {}
  const Plan& plan;
  NodeSpectra spectra;
};

/// Places at which a line's air is looked at unless an accuracy says how many.
constexpr int kUsualPlaces = 24;

/// What is darker counts as this much, per slot: 1e-3 of a high percentile of what the film sees in the darkest of its frames, but at least kDarkest.
std::vector<double> filmFloors(const Simulation& simulation, const NodesOfPlan& fine, SightRays& rays);

/// The fewest places at which air may be looked at along lines of sight, for channels to be within a part of the accuracy that leaves the rest to wavelengths:
/// short waves see it bend where long ones don't. On some of the film's lines and the extremes.
int airPlacesFor(const Simulation& simulation, const NodesOfPlan& fine, SightRays& rays, double accuracy, const std::vector<double>& floor);

/// One per slot. `fine`: makePlan() with reference sampling, of the same outputs. `floor`: filmFloors(). `places`: at which the air is looked at, alike on
/// both sides, so that only wavelengths differ. Terms are those of `fine`; `plan` may leave kinds of terms out, all of them or by node.
std::vector<LineFigures> checkLines(const Simulation& simulation, const NodesOfPlan& plan, const NodesOfPlan& fine, const std::vector<SightRay>& lines,
                                    int places, const std::vector<double>& floor);
/// Of several plans at once.
std::vector<std::vector<LineFigures>> checkLines(const Simulation& simulation, std::span<const NodesOfPlan* const> plans, const NodesOfPlan& fine,
                                                 const std::vector<SightRay>& lines, int places, const std::vector<double>& floor);

}  // namespace pitviper
