#pragma once
// What is said of light scattered more than once, as it is when the second of a scenario's time begins in which a picture lies: it changes as slowly as the
// sun's height and the camera's, and following photons for every picture took up to a fifth of the processor's time.
#include <future>

#include "sim/plan/scattered_again.hpp"

namespace pitviper {

class ScatteringBySecond {
 public:
  /// As ScatteringCheck's.
  ScatteringBySecond(const Simulation& simulation, const Camera& camera, const Plan& plan)
      : simulation_(simulation), camera_(camera), check_(simulation, camera, plan) {}
  /// A picture of this state is begun: its second is looked at in a thread of its own that gives way to what draws. Where the camera is not where the scenario
  /// has it (commands, what points it) it is looked at from where it is, once a second, by this thread.
  void begin(const WorldState& state);
  /// Of the picture that was begun. Of several pictures, the next second is looked at from now on.
  const std::vector<ScatteredAgain>& finish();

 private:
  void lookAt(double second_s);
  const Simulation& simulation_;
  const Camera& camera_;
  ScatteringCheck check_;
  double second_s_ = 0.0;  ///< of the picture
  std::optional<double> found_s_, asked_s_;
  bool isFirst_ = true, follows_ = false;  ///< the second: the camera is where the scenario has it
  std::vector<ScatteredAgain> found_;
  std::future<std::vector<ScatteredAgain>> asked_;  ///< its destructor waits, so nothing it uses goes first
};

}  // namespace pitviper
