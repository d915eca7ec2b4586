#pragma once
// What the truth of a camera's targets is measured in, and is planned together with what the camera draws.
#include "sim/plan/sight_rays.hpp"

namespace pitviper {

/// The radiance of each channel, and what a detector counts.
std::vector<ChannelOutput> measuredOutputs(const Simulation& simulation, const Camera& camera);

struct PlannedOutputs {
  std::vector<ChannelOutput> drawn, measured;
};
/// What a plan is made for. Nothing is measured where a plan has no room for that, is no one's to choose, or was given: that is a plan of its own.
PlannedOutputs plannedOutputs(const Simulation& simulation, const Eye& eye);

}  // namespace pitviper
