#pragma once
// Air known from tables along level paths, as the path of a scene.
//
// Law: -ln tau = sum over k of c_k R^a_k with the length R of the whole way [km], both legs of reflected light in one; L_path = J (1 - tau).
// Valid: where tabulated_air.hpp says. The air is the same everywhere and has no end: the way's height and direction don't matter, the sun's
// irradiance is that at the scene, and a ray that meets nothing sees J. A TabulatedSky is not used.
#include <memory>

#include "atmosphere/tabulated_air.hpp"
#include "sim/model/atmosphere.hpp"

namespace pitviper {

/// Amounts are all the same: the length of the way [km]. Throws std::invalid_argument for more than kMostAirAmounts exponents.
std::shared_ptr<const Atmosphere> makeTabulatedPath(TabulatedAir air);

}  // namespace pitviper
