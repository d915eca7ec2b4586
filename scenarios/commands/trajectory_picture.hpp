#pragma once
// Trajectories for people, as a PNG: paths in space above a floor, with their shadows on it, times, cameras and closest approaches. Drawn by VTK in the module
// of the charts (charts.hpp), loaded on demand; works without a display.
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "sim/image/atomic_file.hpp"

namespace pitviper {

/// Positions are east, north, up [m]. A position that is not finite is where the body was not there. One place: it stood.
struct FlownPath {
  std::string name;
  std::vector<double> time_s;  ///< rising
  std::vector<glm::dvec3> position_m;
  bool isCamera = false;
};

/// Where two bodies were closest.
struct FlownMeeting {
  std::string body, target;
  double time_s = 0.0, distance_m = 0.0;
  glm::dvec3 at{0.0}, targetAt{0.0};
};

/// A camera and its line of sight at a time.
struct FlownSight {
  std::string camera;
  double time_s = 0.0;
  glm::dvec3 from{0.0}, along{1.0, 0.0, 0.0};  ///< the second of unit length
  double length_m = 0.0;                       ///< to what it looks at; 0: to the end of the picture
};

struct FlownScene {
  std::string title;
  std::vector<FlownPath> paths;
  std::vector<FlownMeeting> meetings;
  std::vector<FlownSight> sights;
};

/// Bodies whose names differ only in the digits at their ends share a colour. Heights are drawn to the scale of the ground, unless the scene is flatter than
/// 1:10: then the picture says how many times higher they are drawn. `texts`, `mayReplace`: as of writePng. Needs no GlContext and leaves the caller's alone.
/// Errors: UserError if the module is missing (says what to install), OutputError if the file cannot be stored, std::invalid_argument for paths of unequal
/// times and positions or none with a finite place, std::runtime_error if drawing failed.
void drawTrajectories(const FlownScene& scene, const std::filesystem::path& png, const std::map<std::string, std::string>& texts = {},
                      const MayReplace& mayReplace = {});

}  // namespace pitviper
