#pragma once
// Which channels see films whose fringes are closer together than the reference's wavelengths: they are averaged there, and that is said.
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

struct AveragedFringes {
  std::string material, channel;
  double apart_um = 0.0, at_um = 0.0;  ///< where they are closest in the channel
  double width_um = 0.0;               ///< of the reference's bins there
  bool narrow = false;                 ///< the channel is too narrow to be sure that its own average is the same
};

/// One for each pair of a channel and a material.
std::vector<AveragedFringes> averagedFringes(const Simulation& simulation, const std::vector<ChannelOutput>& outputs);

/// "fringes of 'film' are 0.33 nm apart at 0.45 um, ..."
std::string wordsOf(const AveragedFringes& fringes);

}  // namespace pitviper
