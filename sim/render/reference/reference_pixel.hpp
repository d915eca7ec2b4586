#pragma once
// The same pixel in double precision on the CPU: geometry by casting a ray through every triangle, radiance from the models
// themselves (no tables between). Slow, for tests and for judging the GPU's rounding.
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/render/view.hpp"

namespace pitviper {

struct ReferencePixel {
  std::vector<double> slots;     ///< integrals of kernel x radiance
  std::vector<double> radiance;  ///< per node [W/(m2 sr um)]
  int entity = -1;
  int surface = -1;
  double range_m = 0.0;
  double cosView = 0.0;
  double temperature_K = 0.0;
};

/// The centre of pixel (x, y) of a view, counted from the lower left.
ReferencePixel referencePixel(const Simulation& simulation, const Plan& plan, const View& view, const WorldState& state, int x, int y);

}  // namespace pitviper
