#pragma once
// A calibrated frame: what leaves the renderer, with everything needed to use it without the scenario at hand.
#include <string>
#include <vector>

#include "sim/image/exr.hpp"

namespace pitviper {

/// One image in one unit: row-major, row 0 at the top.
struct FrameLayer {
  std::string name;  ///< "mw.radiance", "truth.range"
  std::string unit;
  std::vector<float> pixels;
};

struct Frame {
  std::string camera;
  std::string kind;  ///< "": the camera's channels; "spectral": its spectral image
  int number = 0;
  double time_s = 0.0;
  int width = 0, height = 0;
  std::vector<FrameLayer> layers;  ///< channels first, then truth
  std::vector<Attribute> attributes;
};

/// "<camera>_00012" or "<camera>_00012_<kind>": the name of a frame's files without extension.
std::string frameFileStem(const Frame& frame);
std::string frameFileStem(const std::string& camera, int number, const std::string& kind);

}  // namespace pitviper
