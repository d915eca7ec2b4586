#pragma once
// What a plan's wavelengths are off by on lines of sight: its nodes against the fine grid, both summed by the radiance equation in double precision.
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
};

/// A plan with the spectra that lines have in common at its nodes. Both must outlive it.
struct NodesOfPlan {
  NodesOfPlan(const Simulation& simulation, const Plan& of) : plan(of), spectra(simulation, of.nodes) {}
  const Plan& plan;
  NodeSpectra spectra;
};

/// One per slot. `fine`: makePlan() with reference sampling, of the same outputs. `floor`: per slot; where empty it becomes 1e-3 of the 99th percentile of
/// these lines. Terms are those of `fine`; `plan` may leave kinds of terms out, all of them or by node.
std::vector<LineFigures> checkLines(const Simulation& simulation, const NodesOfPlan& plan, const NodesOfPlan& fine, const std::vector<SightRay>& lines,
                                    double pixel_sr, std::vector<double>& floor);

}  // namespace pitviper
