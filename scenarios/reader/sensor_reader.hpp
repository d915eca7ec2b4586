#pragma once
// A sensor in a file of its own, for spectral images that are there already.
#include <filesystem>

#include "scenarios/reader/scenario_reader.hpp"

namespace pitviper {

struct Sensor {
  std::string name;
  std::string sha256;  ///< of its file
  Pinhole pinhole;
  double exposure_s = 0.0;  ///< 0: none given
  std::vector<ChannelOutput> outputs;
};

/// What the file does not say is as of the camera that drew the image. Every mistake is a UserError.
Sensor readSensor(const std::filesystem::path& file, const Pinhole& image, double exposure_s, const Libraries& libraries);

}  // namespace pitviper
