#pragma once
// A point light in view adds its own flux, I tau A_ap cos(psi) / R^2, to the subpixel it falls into, unless something stands in
// front of it on the very line to it.
#include "sim/render/subpixels.hpp"

namespace pitviper {

void addVisibleLights(Subpixels& image, ScenePass& pass, const Simulation& simulation, const Plan& plan, const WorldState& state,
                      const std::vector<char>& present);

/// True where nothing present stands between a place and a direction (unit) up to a distance.
bool isFree(ScenePass& pass, const WorldState& state, const std::vector<char>& present, const glm::dvec3& from, const glm::dvec3& direction, double distance_m,
            double near_m);

/// Integral of kernel x I x tau over a slot's nodes [kernel unit x W/sr] for a light seen from a place.
std::vector<double> apparentIntensity(const Simulation& simulation, const Plan& plan, const WorldState& state, size_t light, const glm::dvec3& from);

}  // namespace pitviper
