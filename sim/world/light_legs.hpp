#pragma once
// The way from a place on a surface to a light.
#include "sim/world/ray_hits.hpp"

namespace pitviper {

struct LightLeg {
  glm::dvec3 toLight{0.0};  ///< unit, local frame; of the sun over the earth the middle of what stands above the place's horizon
  double distance_m = 0.0;  ///< infinite for the sun
  double factor = 0.0;      ///< irradiance for an intensity (for the sun: an irradiance) of 1 without air: cosine x pattern / distance^2 (for the sun: cosine x
                            ///< share of its disc above the horizon), 0 from behind
  AirAmounts air;           ///< between the surface and the light (of air without a top: none on the way to the sun)
};

/// The sun as it stands over a place: the part of its disc above the place's own horizon where the scene is over the earth, else all of it.
struct SunHere {
  glm::dvec3 toSun{0.0};  ///< of that part's middle, unit, local frame
  double share = 1.0;     ///< of the disc; 0: behind the earth
  AirAmounts air;         ///< on the way there, of air with a top
};
SunHere sunHere(const Simulation& simulation, const glm::dvec3& point);

/// What a lamp sends in a direction (unit, local frame, away from it), as a share of its intensity.
double patternTowards(const Simulation& simulation, const WorldState& state, std::size_t light, const glm::dvec3& direction);

/// The lamp that a light is a point of: as a rule itself.
std::size_t lampOf(const Simulation& simulation, std::size_t light);

/// `light`: an index into Simulation::lights, or their number for the sun.
LightLeg lightLeg(const Simulation& simulation, const WorldState& state, const Hit& hit, std::size_t light);

/// A direction in a frame whose z is the normal: what reflection components take.
glm::dvec3 inNormalFrame(const glm::dvec3& normal, const glm::dvec3& direction);

}  // namespace pitviper
