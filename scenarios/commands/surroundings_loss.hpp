#pragma once
// What ambient light by direction loses where it is told by few numbers: against the integral over all light.
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// Of the material of a simulation's first entity, at height 0 of its surroundings: a table by wavelength of errors of the whole radiance of a surface of
/// 300 K, over 4 tilts of it, 4 azimuths, 5 view angles and 2 azimuths of view. Root of their mean square, and the largest, over the root of the radiance's
/// mean square.
std::string surroundingsLoss(const Simulation& simulation);

}  // namespace pitviper
