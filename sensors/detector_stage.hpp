#pragma once
// The detector at work: pictures of photoelectrons become counts.
#include <functional>
#include <memory>

#include "sim/camera/sensor_stage.hpp"
#include "sim/model/detector_law.hpp"

namespace pitviper {

/// Of 24 bits, of a channel's name alone, whatever other channels there are.
std::uint32_t channelNumber(const std::string& channel);

/// The camera that it was designed for: what its correction was learnt with.
struct DetectorDesign {
  double exposure_s = 0.0, axis_sr = 0.0;
  std::function<double(const ChannelOutput&)> ownLight;  ///< of its lens and housing, electrons on the axis
};

std::unique_ptr<SensorStage> makeDetectorStage(const DetectorLaw& law, const DetectorDesign& design);

}  // namespace pitviper
