#pragma once
// What a window shows and what its panels share.
#include <deque>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/view/layer_look.hpp"
#include "scenarios/view/picture_maker.hpp"
#include "scenarios/view/view_options.hpp"
#include "scenarios/view/window/marks.hpp"
#include "scenarios/view/window/picture_tile.hpp"
#include "sim/image/exr.hpp"

namespace pitviper {

enum class Tool { Probe, Region, Profile, Fly };

struct Overlays {
  bool outlines = false, boxes = false, names = true, ranges = true, gate = false;
};

/// Values of a pixel in one picture.
struct PixelThen {
  double time_s;
  std::vector<double> values;  ///< of `layers`
};

struct ViewState {
  Marks marks;
  ViewWish wish;
  // What is shown.
  ViewedScenePointer asRead, scene;  ///< the second with what was edited in it
  std::size_t camera = 0;
  double time_s = 0.0;
  HandChanges hands;
  double accuracy = 0.0;  ///< 0: the scenario's
  ShownPicturePointer picture;
  MakerStatus status;
  bool isDone = false;
  double pictures_s = 0.0;  ///< pictures a second, lately
  double window_ms = 0.0;   ///< of the last frame of the window
  double window_s = 0.0;    ///< frames of the window a second, lately
  std::string problem;      ///< of the file that was saved
  std::string message;      ///< of what was done last
  double messageUntil_s = 0.0;
  std::vector<std::filesystem::path> files;  ///< frames, where no scenario is shown
  std::size_t file = 0;
  // How it is shown.
  FrameLook look;
  std::vector<std::string> shown;  ///< layers
  bool composite = false;
  std::vector<std::string> three;  ///< of a composite
  Overlays overlays;
  EntityShapes shapes;
  TileZoom zoom;
  Tool tool = Tool::Probe;
  // Time.
  bool isPlaying = false, loops = true;
  double speed = 1.0;
  // What is looked at.
  std::optional<glm::ivec2> pixel;
  std::optional<PixelBox> region;
  std::optional<glm::ivec4> profile;
  std::deque<PixelThen> history;
  std::vector<std::string> historyLayers;
  std::optional<glm::ivec2> historyPixel;

  bool hasScene() const { return scene != nullptr; }
  const Camera& cameraShown() const { return scene->simulation.cameras[camera]; }
  void say(const std::string& text);
  /// Of a layer of the camera shown, where it has one.
  const BandTemperature* temperatureOf(const std::string& layer) const;
};

}  // namespace pitviper
