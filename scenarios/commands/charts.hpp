#pragma once
// Charts for people, as PNG: several panels on one sheet. They are drawn by VTK in a module of its own, loaded on demand, so that
// everything else runs where VTK is not installed. Works without a display.
#include <filesystem>
#include <string>
#include <vector>

namespace pitviper {

/// Points in the order given, joined by a line, or bars from zero. Points that are not finite, or not above zero on a logarithmic
/// axis, are left out.
struct Series {
  std::string name;  ///< in the legend; a panel's only series needs none
  std::vector<double> x, y;
  bool dashed = false;  ///< a figure to compare with, rather than a measured one
  bool bars = false;
};

struct Chart {
  std::string title, xLabel, yLabel;
  bool logX = false, logY = false;
  bool yFromZero = false;  ///< even where all values are far from it
  std::vector<Series> series;
  std::vector<double> xTicks;           ///< where x has few values of its own; empty: round numbers
  std::vector<std::string> categories;  ///< what stands at x = 0, 1, 2 ... instead of numbers
};

/// Draws the charts in rows of `columns` panels, on white. Written atomically; the same charts give the same bytes on the same driver.
/// Needs no GlContext and leaves the caller's alone. Errors: UserError if the module is missing (says what to install), OutputError
/// if the file cannot be stored, std::invalid_argument for no charts, unequal x and y or a sheet beyond 16384 pixels,
/// std::runtime_error if drawing failed.
void drawCharts(const std::vector<Chart>& charts, int columns, const std::filesystem::path& png);

/// NAME.csv and NAME.png in a folder, each said when it is written. Errors: as of drawCharts().
void writeWithCharts(const std::filesystem::path& folder, const std::string& name, const std::string& csv, const std::vector<Chart>& charts, int columns);

/// Errors: UserError if the module is missing or cannot be loaded.
void requireCharts();

}  // namespace pitviper
