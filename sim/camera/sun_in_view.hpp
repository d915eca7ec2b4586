#pragma once
// The disc of the sun, or of the moon that stands for it, where a camera sees it: even, of the radius and the irradiance that light surfaces.
//
// Law: radiance = irradiance / (pi r^2) through the air towards it and what is seen through before it; r its angular radius (sun_disc.glsl). Nothing where
//   something solid or the earth stands before it. Of a subpixel the share that it fills.
// Valid: r small; no darkening to the limb (centre 1.2 times the mean in the visible, less in the infrared), no phases of the moon, light for a scene's origin.
#include "sim/camera/visible_lights.hpp"

namespace pitviper {

void addSunInView(Subpixels& image, const WaysToLights& ways, const Simulation& simulation, const Plan& plan, const WorldState& state,
                  const std::vector<char>& present);

}  // namespace pitviper
