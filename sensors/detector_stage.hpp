#pragma once
// The detector at work: pictures of photoelectrons become counts.
#include <memory>

#include "sim/camera/sensor_stage.hpp"
#include "sim/model/detector_law.hpp"

namespace pitviper {

/// Of 24 bits, of a channel's name alone, whatever other channels there are.
std::uint32_t channelNumber(const std::string& channel);
/// Standard deviation of 1/f noise of FlickerNoise's unit octaves [electron].
double flickerOctave(const DetectorLaw& law, double step_s);

std::unique_ptr<SensorStage> makeDetectorStage(const DetectorLaw& law);

}  // namespace pitviper
