#pragma once
// The GPU's picture against the double precision reference of the same pixels.
#include "sim/plan/plan.hpp"

namespace pitviper::test {

struct Worst {
  double error = 0.0;
  double percentile99 = 0.0;
  double covered = 0;  ///< pixels compared
  double missed = 0;   ///< pixels that see another surface than the reference does
};

/// Worst relative error of camera 0 at time 0 over every `stride`th pixel that sees the same surface on both sides (a silhouette may fall
/// either way).
Worst compare(const Simulation& simulation, int stride);
/// The same with a plan that was made elsewhere: both sides have its nodes, so that what tables and single precision lose is left. Pixels darker than `floor`
/// of the brightest are told by that.
Worst compare(const Simulation& simulation, const Plan& plan, int stride, double floor = 0.0);

}  // namespace pitviper::test
