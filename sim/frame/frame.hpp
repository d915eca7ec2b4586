#pragma once
// A calibrated frame: what leaves the renderer, with everything needed to use it without the scenario at hand.
#include <optional>
#include <string>
#include <vector>

#include "sim/frame/frame_stamp.hpp"
#include "sim/image/exr.hpp"

namespace pitviper {

/// One image in one unit: row-major, row 0 at the top.
struct FrameLayer {
  std::string name;  ///< "mw.radiance", "truth.range"
  std::string unit;
  std::vector<float> pixels;
};

/// What is true of a body, a plume, a flare or a lamp in a frame (sim/frame/truth_table.hpp).
struct TargetRow {
  std::string name, kind;              ///< "body", "medium", "plume", "flare", "lamp"
  double column = 0.0, row = 0.0;      ///< of its middle [pixels from the top left corner]; NaN behind the camera
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;  ///< the box around its outline, whatever hides it [pixels]; NaN where it is not in view
  double range_m = 0.0, rangeRate_m_s = 0.0;
  double sightRight_rad_s = 0.0, sightUp_rad_s = 0.0;  ///< turning of the line of sight to it, in the camera's axes at that time
  double visible = 0.0;                ///< share of its outline's solid angle that is within the film and not hidden by what is opaque
  struct Channel {
    std::string channel, unit;  ///< of an intensity: "W/sr" of a radiance
    double own = 0.0;           ///< what it sends and reflects, that reaches the aperture, times range squared
    double total = 0.0;         ///< all light along the lines that meet it: with the air's, and what is seen through it
    double contrast = 0.0;      ///< what the picture would lose without it
    double signalToNoise = 0.0;  ///< of its contrast in the best pixel; NaN without a detector, and where that pixel is full
    int saturated = -1;          ///< pixels in its box that are full; -1 without a detector
  };
  std::vector<Channel> channels;
};

struct Frame {
  std::string camera;
  std::string kind;  ///< "": the camera's channels; "spectral": its spectral image
  int number = 0;
  double time_s = 0.0;
  int width = 0, height = 0;
  std::vector<FrameLayer> layers;  ///< channels first, then truth
  std::vector<Attribute> attributes;
  std::vector<TargetRow> targets;  ///< where the camera's `truth` asks for them
  std::optional<FrameStamp> stamp;  ///< of a stream's frames
};

/// "<camera>_00012" or "<camera>_00012_<kind>": the name of a frame's files without extension.
std::string frameFileStem(const Frame& frame);
std::string frameFileStem(const std::string& camera, int number, const std::string& kind);

}  // namespace pitviper
