#pragma once
// A lab bench: what a camera's pictures say of it, beside what its design says.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/commands/charts.hpp"
#include "sensors/noise_components.hpp"
#include "sensors/resolvable.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

struct BenchOptions {
  std::string camera;     ///< YAML of a camera, without name and place: keys of a sensor file's `camera`
  std::string base;       ///< folder that files in it are relative to
  std::vector<std::string> changes = {};  ///< "cameras.bench.exposure=2 ms"
  int frames = 64;        ///< of each flat field
  int film_px = 128;      ///< a side of the square of the film's middle that is measured
  double step_s = 1.0 / 50.0;
  long long seed = 1;
};

/// A figure of the design and the same from pictures alone.
struct BenchFigure {
  std::string name, unit;
  double design = 0.0, measured = 0.0;
  double error = 0.0;     ///< standard error of what is measured, where it is known; 0: not
  bool absolute = false;  ///< compared by difference, not by ratio
};

/// What observers and thresholds see of it.
struct BenchSight {
  Resolving design;                   ///< by its figures
  std::optional<Resolving> measured;  ///< by its pictures: their noise, and the contrast of their edge in all directions; none: there is no edge
  ChannelOutput output;
  double electrons_per_K = 0.0, noise_electrons = 0.0;  ///< at the flat fields' temperature; of a pixel from frame to frame
  double pixel_sr = 0.0, shareInMiddle = 1.0, shareInCorner = 1.0;  ///< of a spot's light, on its pixel
  bool seesHeat = false;                                            ///< of 300 K: what it is measured at
  double pixels_per_s = 0.0;                                        ///< of the whole film
};

struct BenchResult {
  std::string channel;
  double temperature_K = 0.0;  ///< of the flat fields
  std::vector<BenchFigure> figures;
  std::vector<Chart> charts;
  std::vector<std::string> notes;
  BenchSight sight;
};

/// Of each channel with counts. Needs a current GlContext. Errors: UserError where the camera makes no counts. `progress`: what is done now, and the share of
/// all.
std::vector<BenchResult> measureCamera(const BenchOptions& options, const std::function<void(const std::string& what, double share)>& progress);

}  // namespace pitviper
