#pragma once
// Stars where a camera sees them: points of light.
//
// Law: irradiance through the air towards it, on the film as that of a point; nothing where something solid or the earth stands before it.
// Valid: light for a scene's origin; a star stands where it stood at frame 0; scintillation is left out.
#include "sim/camera/visible_lights.hpp"

namespace pitviper {

void addStarsInView(Subpixels& image, const WaysToLights& ways, const Simulation& simulation, const Plan& plan, const WorldState& state,
                    const std::vector<char>& present);

}  // namespace pitviper
