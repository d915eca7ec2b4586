#pragma once
// Moves groups towards the smallest largest error.
#include <functional>

#include "sim/plan/product_set.hpp"

namespace pitviper {

struct RefineLimits {
  int rounds = 12;
  double goal = 0.0;  ///< stop once the largest error is below
  std::function<bool()> expired = [] { return false; };
};

/// Where a refinement stands, to go on with other products.
struct RefineProgress {
  int round = 0;          ///< sets p
  double damping = 0.1;   ///< relative to the mean curvature
  double rootStep = 4.0;  ///< see GroupStep::solve
  int place = 0;          ///< of the last step's length among those tried
};

/// Gauss-Newton on the p-norm of the errors (p rising from 2 towards the maximum), all extinctions and shares together (group_step.hpp), put back
/// onto shares >= 0 that sum to 1 and extinctions >= 0.
/// A share of exactly 0 stays 0. Returns the largest error; the state is never worse in it than what was given.
double refineGroups(const ProductSet& set, GroupState& state, RefineProgress& progress, const RefineLimits& limits);

}  // namespace pitviper
