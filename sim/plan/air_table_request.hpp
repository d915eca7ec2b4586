#pragma once
// What an atmosphere needs to choose how large its tables are.
#include "sim/plan/plan.hpp"

namespace pitviper {

class SightRays;

struct AirTableRequest {
  const Simulation& simulation;
  Plan& plan;                        ///< for its nodes; takes the sizes
  const Camera* camera;              ///< null: a probe
  SightRays* rays;                   ///< null: the usual sizes, nothing is known yet
  const std::vector<double>* floor;  ///< of each slot, where it is dark
};

}  // namespace pitviper
