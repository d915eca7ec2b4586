#pragma once
// Reads a sweep's file and draws all of its samples.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/sweep/sample_design.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "scenarios/sweep/sweep_draw.hpp"

namespace pitviper {

struct Sweep {
  std::string name, file;
  std::string text;    ///< all that it was read from: the file, and hashes of its table and its files of Python
  std::string sha256;  ///< of that text
  std::filesystem::path scenario;
  std::vector<std::string> sets;  ///< "path.to.key=value" of every sample, before its own
  int frame = 0;                  ///< of the scenario, that is drawn
  long long seed = 1;
  Design kind = Design::Random;
  std::vector<SweepFactor> factors;
  /// Of the whole design, by rising number; those that break a constraint are left out and their numbers with them, so that numbers may have gaps (never of
  /// random and sobol_indices).
  std::vector<Sample> samples;
  std::shared_ptr<const SweepDraw> draw;  ///< that these came from
  std::vector<Measure> measures;
  Value sinks;  ///< as written: a list; null where absent
  bool keepsFrames = false;
};

/// Errors: UserError with the place of every mistake in the file, and of designs that the memory does not hold.
Sweep readSweep(const std::filesystem::path& file);

/// What the file can hold, for scenarios/README.md: behind the keys of scenarios.
std::string sweepKeyReference();

}  // namespace pitviper
