#pragma once
// Panels of a sweep's report: how a measure is spread, how strongly it goes with factors, and how.
#include <string>
#include <vector>

#include "scenarios/sweep/sobol_indices.hpp"
#include "scenarios/sweep/svg_drawing.hpp"
#include "scenarios/sweep/sweep_identity.hpp"

namespace pitviper {

/// Of a panel with all that is written around it [pixels].
inline constexpr double kSweepPanelWidth = 350.0, kSweepPanelHeight = 240.0;

/// Where a panel goes in a drawing: its upper left corner, and its height where that is not the usual one.
struct SweepPanel {
  SvgDrawing& drawing;
  double left = 0.0, top = 0.0, height = kSweepPanelHeight;
};

/// Numbers of samples; the median and the middle 90 % are marked.
void drawHistogram(const SweepPanel& panel, const MeasureColumn& measure, const std::vector<double>& values);

/// One bar or two of each factor.
struct SweepBar {
  std::string factor;
  double value = 0.0;
  Interval interval;
  double second = 0.0;  ///< NaN: there is one bar
  Interval secondInterval;
};

/// Height that a panel of bars takes [pixels].
double barsHeight(const std::vector<SweepBar>& bars);

/// The largest on top; from -1 or 0 to 1, and farther, to 1.5, where a bar goes farther. `title` tells what they are, `second` what the paler ones are.
void drawBars(const SweepPanel& panel, const std::string& title, const std::string& second, std::vector<SweepBar> bars, double low);

/// A dot for each sample, `mostDots` at most, evenly taken from all. Choices lie side by side, each spread out by the sample's number.
void drawScatter(const SweepPanel& panel, const SweepFactor& factor, const MeasureColumn& measure, const std::vector<double>& x, const std::vector<double>& y,
                 std::size_t mostDots);

}  // namespace pitviper
