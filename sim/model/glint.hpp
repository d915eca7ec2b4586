#pragma once
// How strongly sharp lobes throw a light towards a viewer: where pictures and what is fitted to them have to look closely.
#include "sim/model/light_legs.hpp"

namespace pitviper {

/// Lamps of a scenario, and the sun as the last.
std::size_t countLights(const Simulation& simulation);

/// cos(theta_l) x lobe / its maximum, summed over the lobes that are sharper than a diffuse one; 0 where there are none or the light is below the surface.
/// `light`: of countLights(); `direction`: of the line of sight, unit.
double glintOf(const Simulation& simulation, const WorldState& state, const Hit& hit, const glm::dvec3& direction, std::size_t light);

}  // namespace pitviper
