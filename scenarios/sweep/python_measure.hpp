#pragma once
// A user's function of Python that measures frames, in a process of its own.
#include <memory>
#include <string>
#include <vector>

#include "scenarios/sweep/sweep.hpp"
#include "sim/frame/frame.hpp"

namespace pitviper {

class PythonMeasure {
 public:
  /// Starts Python with the file and the function of a measure (scenarios/python/measure_server.py). Errors: UserError at the measure where there is no
  /// Python with numpy, no such file or function, or the file cannot be run.
  explicit PythonMeasure(const Measure& measure);
  ~PythonMeasure();
  PythonMeasure(const PythonMeasure&) = delete;
  PythonMeasure& operator=(const PythonMeasure&) = delete;

  /// What the function gives for a frame: as many numbers as the measure has names; NaN for None. `factors`: of the sample. Errors: UserError with what it
  /// threw.
  std::vector<double> of(const Frame& frame, const std::vector<SweepFactor>& factors, const Sample& sample);

 private:
  struct Process;
  Measure measure_;
  std::unique_ptr<Process> process_;
};

}  // namespace pitviper
