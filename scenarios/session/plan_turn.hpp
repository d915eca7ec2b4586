#pragma once
// Processes that need the same plan at the same time take turns: the first makes it, the others find it.
#include <functional>

#include "sim/model/simulation.hpp"

namespace pitviper {

class PlanTurn {
 public:
  /// Waits while another process of this machine makes the plan of a camera as it is drawn; `waiting` is called meanwhile and may throw. Where there is no
  /// cache to find plans in, it waits for nobody.
  PlanTurn(const Simulation& simulation, const Camera& drawn, const std::function<void()>& waiting);
  ~PlanTurn();
  PlanTurn(const PlanTurn&) = delete;
  PlanTurn& operator=(const PlanTurn&) = delete;

 private:
  int file_ = -1;
};

}  // namespace pitviper
