#pragma once
// How strongly sharp lobes throw a light towards a viewer: where pictures and what is fitted to them have to look closely.
#include "sim/world/light_legs.hpp"

namespace pitviper {

/// Lamps of a scenario, and the sun as the last.
std::size_t countLights(const Simulation& simulation);

/// Whether one of a surface's lobes is sharper than a diffuse one.
bool isGlossy(const Simulation& simulation, const Hit& hit);

/// 1 - cos of the angle between a light's mirrored direction and the viewer, 0 to 2: what glints most is least; infinite where the light is below the surface
/// or out. `light`: of countLights(); `direction`: of the line of sight, unit.
double offMirror(const Simulation& simulation, const WorldState& state, const Hit& hit, const glm::dvec3& direction, std::size_t light);

/// cos(theta_l) x lobe / its maximum, summed over the sharp lobes; 0 where there are none or the light is below the surface or out.
double glintOf(const Simulation& simulation, const WorldState& state, const Hit& hit, const glm::dvec3& direction, std::size_t light);

}  // namespace pitviper
