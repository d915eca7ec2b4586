#pragma once
// Whether all that a scene is made of has data wherever a channel responds; and responses cut where they hardly do beyond it.
#include "sim/model/channel.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Share of the integral of a response that may be cut off where a scene has no data: half of the 1 % that pictures in layered air are
/// drawn to unless asked for otherwise.
constexpr double kMostCut = 0.005;

/// Where the air, a material, a light, the sun, ambient light or the background has no data for less than kMostCut of the kernel's integral the
/// kernel is 0 from there on, and output.cut says so; returns the share left. Throws UserError at the place of what ends, naming the share lost,
/// where it is more.
double cutToData(const Simulation& simulation, ChannelOutput& output);

/// Throws the same wherever anything is missing, however little.
void requireData(const Simulation& simulation, const ChannelOutput& output);

}  // namespace pitviper
