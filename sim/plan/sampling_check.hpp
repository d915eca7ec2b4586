#pragma once
// Whether a plan's wavelengths do for the gases of a scene, whose bands are narrower than any surface's.
#include <string>
#include <vector>

#include "sim/plan/plan.hpp"

namespace pitviper {

/// What the emission of a medium of a thickness is off by in a channel.
struct SamplingNote {
  std::string medium, channel;
  double thickness_m = 0.0;
  double error = 0.0;  ///< relative, of the integral of kernel x B(T) x (1 - exp(-k s))
};

/// The worst of each medium at its own temperature, through a tenth of its body's radius and the radius, where it exceeds `allowed`;
/// worst first. Channels in which it does not shine to speak of are left out. Held against Gauss points between all knots of kernel and absorption.
std::vector<SamplingNote> checkSampling(const Simulation& simulation, const Plan& plan, const std::vector<ChannelOutput>& outputs, double allowed);

/// What a film's reflectance (at normal incidence), or where the channel sees thermal light its emission, is off by in a channel.
struct FringeNote {
  std::string material, channel;
  double error = 0.0;
};

/// Films whose fringes a plan's wavelengths step over, by more than `allowed`; worst first. Held against the reference's wavelengths.
std::vector<FringeNote> checkFringes(const Simulation& simulation, const Plan& plan, const std::vector<ChannelOutput>& outputs, double allowed);

}  // namespace pitviper
