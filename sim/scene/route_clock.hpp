#pragma once
// When a body that flies its route at a speed of its own is where: the time for which the route has it there.
#include <vector>

#include "sim/scene/motion.hpp"

namespace pitviper {

class RouteClock {
 public:
  /// From where the motion is at a time on. Before the first point of one that holds or vanishes there it waits as it would.
  RouteClock(const Motion& motion, double from_s);
  /// The motion's time, so long after [s] at a speed [m/s]. Where the route stands still it goes on at once; beyond the end as the motion says.
  double at(double speed_m_s, double after_s) const;
  /// Seconds of the route a second, where it begins.
  double rate(double speed_m_s) const;

 private:
  double from_s_, waits_s_ = 0.0;
  bool loops_ = false;
  double lastSpeed_m_s_ = 0.0;       ///< beyond the end of one that goes on; 0: it has none there
  std::vector<double> time_s_, way_m_;  ///< of the motion, and how far it has got; both rise
};

}  // namespace pitviper
