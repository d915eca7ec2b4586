#pragma once
// Which point lights can matter to which bodies: the others cost nothing.
#include <vector>

#include "sim/render/tables.hpp"

namespace pitviper {

class LightRelevance {
 public:
  LightRelevance(const Simulation& simulation, const Plan& plan, const RenderTables& tables);
  /// False where a light is dark, or where the most that a body can reflect of it anywhere is, at every wavelength and for all lights
  /// together, below what single precision can tell from the radiance that its surfaces have by themselves: E f_max < 6e-8 / lights x S.
  bool matters(std::size_t entity, std::size_t light, const WorldState& state) const;

 private:
  const Simulation& simulation_;
  std::vector<double> ratio_;  ///< [entity][light]: greatest f_max I / S over nodes and surfaces at level 1 [m2]; 0: reflects none of it
};

}  // namespace pitviper
