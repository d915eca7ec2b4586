#pragma once
// Times the rows of a factor in rounds, every row right behind the yardstick, so that a drifting machine drifts out of the ratios.
#include <functional>
#include <optional>
#include <vector>

#include "scenarios/commands/bench_factors.hpp"
#include "scenarios/commands/bench_yardstick.hpp"
#include "scenarios/commands/progress.hpp"

namespace pitviper {

/// Every figure is a median: over frames, or over rounds where it is a ratio.
struct BenchRow {
  std::string factor;
  BenchVariant variant;
  int frames = 0;
  double seconds = 0.0;                ///< per frame
  double yardstickSeconds = 0.0;       ///< of the frames between this row's
  double rateByYardstick = 0.0;        ///< pixels a second over the yardstick's
  double timeByBase = 1.0;             ///< of the variant's base
  std::optional<double> costPerLayer;  ///< (time / base - 1) per layer more than the base has

  double pixels() const { return static_cast<double>(variant.setting.film_px) * variant.setting.film_px; }
  double megapixelsPerSecond() const { return pixels() / seconds * 1e-6; }
  double framesPerSecond() const { return 1.0 / seconds; }
};

/// Seconds that drawing takes, the device idle before and after.
double timed(const std::function<void()>& draw);
/// Of at least one value.
double median(std::vector<double> values);

/// Steps of a progress bar that timing a factor takes.
int benchSteps(const BenchFactor& factor, int frames);

/// Up to `frames` frames of each row; fewer of slow ones, one a round at least.
std::vector<BenchRow> timeFactor(const BenchFactor& factor, int frames, Yardstick& yardstick, Progress& progress);

}  // namespace pitviper
