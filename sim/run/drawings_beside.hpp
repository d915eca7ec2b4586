#pragma once
// Drawings that are made while drafts of them are drawn: plans, tables, programs and a first picture, in a thread with a context of its own. Nothing is left
// for the thread that draws but to take them.
#include <atomic>
#include <exception>
#include <string>
#include <thread>

#include "sim/run/camera_drawing.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

class DrawingsBeside {
 public:
  struct Made {
    std::size_t camera;
    std::unique_ptr<CameraDrawing> drawing;
    std::vector<double> work_ns;  ///< of each rung, what a picture took
  };
  enum class Which { First, AllRungs, Draft };
  /// Of some cameras, by their places in the simulation: the first of rungsOf(), all of them, or a draft (kDraft). All must outlive it.
  DrawingsBeside(const Simulation& simulation, const ShaderLibrary& library, std::vector<std::size_t> cameras, Which which, double time_s);
  /// Waits for what cannot be left where it is.
  ~DrawingsBeside();
  DrawingsBeside(const DrawingsBeside&) = delete;
  DrawingsBeside& operator=(const DrawingsBeside&) = delete;

  bool isReady() const { return isReady_; }
  /// About how much of the plan at hand is made, 0 to 1.
  double share() const { return share_; }
  /// Once it is ready. Throws what kept them from being made; where the driver did, nothing is given and why() says it: drafts go on.
  std::vector<Made> take();
  const std::string& why() const { return why_; }

 private:
  void make();
  const Simulation& simulation_;
  const ShaderLibrary& library_;
  std::vector<std::size_t> cameras_;
  Which which_;
  double time_s_;
  std::vector<Made> made_;
  std::exception_ptr thrown_;
  std::string why_;
  std::atomic<bool> isReady_ = false, ends_ = false;
  std::atomic<double> share_ = 0.0;
  std::jthread thread_;
};

}  // namespace pitviper
