#pragma once
// Draws samples of a sweep and measures them, one after the other. A sample does not depend on those before it.
#include <memory>
#include <string>
#include <vector>

#include "scenarios/session/open_scene.hpp"
#include "scenarios/sweep/python_measure.hpp"
#include "scenarios/sweep/sweep_file.hpp"

namespace pitviper {

struct DrawnSample {
  SweepRow row;
  std::vector<std::shared_ptr<Frame>> frames;  ///< of each camera that was drawn
};

class SampleDrawer {
 public:
  /// Reads the scenario with what all samples have set. Errors: UserError, also at a measure that no frame of it has, and what keeps the first sample from
  /// being read: a key that does not exist keeps all of them.
  SampleDrawer(const Sweep& sweep, const std::vector<std::filesystem::path>& roots);

  /// The scenario with what all samples have set.
  const Simulation& simulation() const { return *simulation_; }
  /// Once before the first: plans are made for samples all over the design.
  void prepare();
  /// `allCameras`: not only those that are measured. A sample whose scenario has a mistake, or whose picture cannot be drawn, has a reason instead of measures.
  DrawnSample draw(const Sample& sample, bool allCameras);
  /// Of all columns of measures, as far as frames have told them.
  const std::vector<std::string>& units() const { return units_; }

 private:
  /// The first sample, and one of each choice: what keeps them from being read is found before anything is planned.
  void readSome();
  void measure(const Sample& sample, DrawnSample& drawn);
  const Sweep& sweep_;
  OpenScene scene_;
  std::shared_ptr<const Simulation> simulation_;
  std::vector<std::unique_ptr<PythonMeasure>> python_;  ///< by measure; null: none of Python
  std::vector<std::string> units_;
  double predicted_ = 0.0;  ///< of the sample's frames, the largest
  bool isOutside_ = false;
};

}  // namespace pitviper
