#pragma once
// The plan of a camera of an edited scene, found in a thread of its own while the scene is drawn by the plan before.
#include <atomic>
#include <exception>
#include <thread>

#include "scenarios/view/viewed_scene.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

class PlanBeside {
 public:
  PlanBeside(ViewedScenePointer scene, std::size_t camera, Plan earlier);
  /// Waits for what cannot be left where it is.
  ~PlanBeside() { ends_ = true; }
  PlanBeside(const PlanBeside&) = delete;
  PlanBeside& operator=(const PlanBeside&) = delete;

  bool isReady() const { return isReady_; }
  double share() const { return share_; }
  /// Once it is ready: where the earlier plan holds its groups, terms and tables, with what they lose here. Throws what kept it from being made.
  Plan take();

 private:
  ViewedScenePointer scene_;
  std::size_t camera_;
  Plan earlier_, made_;
  std::exception_ptr thrown_;
  std::atomic<bool> isReady_ = false, ends_ = false;
  std::atomic<double> share_ = 0.0;
  std::jthread thread_;
};

}  // namespace pitviper
