// pitviper view: a window on a scenario, a material or frames.
#include "scenarios/view/view_command.hpp"

#include <stdexcept>

#include "scenarios/commands/options.hpp"
#include "scenarios/view/script.hpp"
#include "scenarios/view/view_options.hpp"
#include "sim/parameters/module_on_demand.hpp"

namespace pitviper {
namespace {

/// A message that says its place itself.
struct Told : UserError {
  explicit Told(const std::string& message) : UserError({message.substr(0, message.find(": ")), 0, 0, -1}, message.substr(message.find(": ") + 2)) {}
};

int view(ViewWish& wish) {
  if (wish.scenario.file.empty() && wish.material.empty())
    throw UserError({"view", 0, 0, -1}, "nothing to be seen", "a scenario, a frame, a folder of frames, or --material NAME", "name one");
  const auto open = reinterpret_cast<WindowFunction>(loadOnDemand(
      {kWindowModule, kWindowFunction, "the window", "GLFW, Xlib and OpenGL",
       "install the packages libglfw3-dev, libx11-dev, libgl-dev and libimgui-dev and build again", "install the packages libglfw3, libx11-6 and libgl1"},
      {"view"}));
  std::string problem;
  const int code = open(&wish, &problem);
  if (code == 2) throw Told(problem);
  if (code != 0) throw std::runtime_error(problem);
  return code;
}

}  // namespace

CommandLine viewCommand() {
  const auto w = std::make_shared<ViewWish>();
  return {{"view", "[SCENARIO.yaml|FRAME|FOLDER]", "a window: look, fly, probe pixels, draw materials' curves, turn the accuracy"},
          "SCENARIO.yaml: its cameras live: at once a sketch, then a draft, then as asked, each named with its error. A saved scenario loads itself again.\n"
          "FRAME: an EXR, TIFF, FITS or ENVI file; FOLDER: all frames in it, as a film.",
          joined(
              std::vector<Option>{
                  {"--camera", "NAME", "the first to be shown; the scenario's first unless given", into(w->camera)},
                  {"--time", "'T s'", "at first", number(w->time_s, {-1e9, 1e9, "s"})},
                  {"--material", "NAME|FILE", "opens the curves of a material: of the scenario's, the library's, or a file as 'pitviper material' takes",
                   into(w->material)},
                  {"--beside", "FRAME", "a second frame: what it has more, pixel by pixel", into(w->beside), "FRAME"},
                  {"--script", "FILE",
                   "does what a file says, a command a line, and ends (below); without a screen: xvfb-run -s '-screen 0 1920x1080x24' pitviper view ...",
                   into(w->script)},
                  {"--width", "N", "of the window, pixels", number(w->width, {1, 16384})},
                  {"--height", "N", "", number(w->height, {1, 16384})},
                  {"--scale", "S", "of letters and all else; the display's unless given", number(w->scale, {0.5, 8.0})}},
              scenarioOptions(w->scenario)),
          [w](const Arguments& words) {
            if (!words.empty()) w->scenario.file = words[0];
            return view(*w);
          },
          "Keys: F1 lists them. Commands of a script:\n" + scriptHelp()};
}

}  // namespace pitviper
