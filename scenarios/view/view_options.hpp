#pragma once
// What `pitviper view` was asked for, and the border to the module that has the window: one C function.
#include <string>
#include <vector>

#include "scenarios/commands/scenario_wish.hpp"

namespace pitviper {

struct ViewWish {
  ScenarioWish scenario;  ///< or a frame, or a folder of them, by its file's name
  std::string material;   ///< to begin with
  std::string beside;     ///< a second frame, of which the difference is shown
  std::string camera;
  std::string script;
  double time_s = -1.0;  ///< below 0: the scenario's first
  int width = 1440, height = 900;
  double scale = 0.0;  ///< of text; 0: the display's
};

inline constexpr const char* kWindowModule = "libpitviper_window.so";
inline constexpr const char* kWindowFunction = "pitviperView";
/// The exit code; what went wrong goes into the text, which is the caller's to tell: 2, a user's mistake; 1, anything else.
using WindowFunction = int (*)(const ViewWish* wish, std::string* problem);

}  // namespace pitviper
