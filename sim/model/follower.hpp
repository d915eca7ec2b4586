#pragma once
// The contract of what points a camera frame by frame: a gimbal, a record of poses. One object for each camera and run, made by the camera's choice.
//
// Order of a frame: tick() says where the camera looks at its time; the picture is drawn with that; look() gets the picture. Whatever a picture or a command
// changes is seen from the next tick on.
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

struct Camera;
struct Simulation;

/// The world at a time, as far as what points a camera knows it.
struct FollowerTick {
  int frame = 0;
  double time_s = 0.0;
  Pose base;                         ///< local frame: the axes that its angles are of, and the camera's place
  std::optional<glm::dvec3> target;  ///< true place of what the camera looks at, if that is there
  double focalLength_m = 0.0;        ///< 0: the camera's own
  std::vector<Pointing> pointings;   ///< the newest commands, oldest first
};

/// Where a camera looks, and what its frame says of that.
struct Followed {
  Pose pose;                             ///< local frame, body axes; x along the line of sight
  std::string driver;                    ///< "truth", "centroid", "commands", "poses"
  std::string mode;                      ///< "tracks", "searches", "coasts", "limited" ...
  glm::dvec2 angle_rad{0.0};             ///< azimuth, elevation to its base
  std::optional<glm::dvec2> rate_rad_s;  ///< of these; none: not known
  bool locked = false;
};

/// What a tracker found in a picture. Pixels from the top left corner of the film.
struct Tracked {
  bool found = false;
  glm::dvec2 at_px{0.0}, fromAxis_px{0.0};  ///< the second: right, down from the middle of the film
  double signal = 0.0, background = 0.0, threshold = 0.0;
  int pixels = 0, saturated = 0;
};

class Follower {
 public:
  virtual ~Follower() = default;
  /// At a frame's time; frames and times rise.
  virtual Followed tick(const FollowerTick& now) = 0;
  /// At a time near the last tick's, for what moves while a frame is exposed and for what comes before the first: changes nothing.
  virtual Pose during(const FollowerTick& then) const = 0;
  /// The last tick's picture, of FollowerChoice::output: as the sensor leaves it, the whole film, rows from the top; NaN where it was not read out.
  virtual Tracked look(std::span<const float> picture) = 0;
  /// What it keeps of the ticks since it was asked last, as lines of its record; whole lines.
  virtual std::string takeRecord() = 0;
};

/// What points a camera, as a scenario or the command line asks for it.
struct FollowerChoice {
  Location where;
  std::string driver;
  std::string words;                  ///< for people: its field and what drives it
  std::string fingerprint;            ///< of everything that the field depends on
  std::optional<std::size_t> output;  ///< of the camera, whose pictures it looks at; none: it looks at none
  bool takesCommands = false;         ///< Courses::pointings
  bool remembers = true;              ///< where it looks depends on the ticks before, all from the scenario's first frame on
  std::string recordHeader;           ///< first line of its record
  std::function<std::unique_ptr<Follower>(const Simulation& simulation, const Camera& camera)> make;
  /// The field, for the plan: where it may look at a time, evenly over its angles, for two shares in [0, 1).
  std::function<Pose(const FollowerTick& then, const glm::dvec2& share)> anywhere;
  /// With a direction of the local frame (of any length) on its axis; none beyond its limits.
  std::function<std::optional<Pose>(const FollowerTick& then, const glm::dvec3& direction)> toward;
};

}  // namespace pitviper
