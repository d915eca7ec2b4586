#pragma once
// What a ray meets, in double precision, through the meshes' trees.
#include <glm/glm.hpp>
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

struct Hit {
  int entity = -1, surface = -1;
  double distance = INFINITY;                    ///< [m]
  glm::dvec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< local frame; the normal towards the viewer
  glm::dvec2 uv{0.0};
  glm::dvec3 facet{0.0, 0.0, 1.0};  ///< unit normal of the triangle itself, outward
  bool front = true;                ///< seen from outside
  std::uint32_t triangle = 0;       ///< of the entity's mesh
  Footprint footprint{};            ///< what a pixel covers; 0 where that does not matter
};

/// A stretch of the ray inside a medium [m].
struct Stretch {
  int entity = -1;
  double enter = 0.0, leave = 0.0;
};

/// A step of the ray in a field.
struct Slab {
  int field = -1;  ///< index into Simulation::fields
  FieldStep step;
};

struct RayHits {
  Hit solid;                       ///< the nearest opaque surface; entity -1: none
  std::vector<Hit> layers;         ///< transparent surfaces before it, in no order
  std::vector<Stretch> stretches;  ///< of media, cut off at it
  std::vector<Slab> slabs;         ///< of fields, cut off at it; field by field, each rising
};

/// The surface of an entity that a triangle of its mesh belongs to.
size_t surfaceOf(const Entity& entity, std::uint32_t triangle);

/// direction of unit length; surfaces nearer than `nearest` are not seen. Source: Moeller and Trumbore 1997.
/// `drawn`: one flag per entity, or null for all; `transparentOnly`: opaque surfaces neither show nor hide. `fieldSteps`: of a field at most; 0: fields are
/// left out.
RayHits castRay(const Simulation& simulation, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double nearest,
                const std::vector<char>* drawn = nullptr, bool transparentOnly = false, int fieldSteps = kReferenceFieldSteps);

/// The steps of a line in all fields, as far as a range [m].
std::vector<Slab> slabsAlong(const Simulation& simulation, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double range_m,
                             int fieldSteps);

/// What a pixel covers of a hit's texture coordinates: `ray` of any length through its middle, `across` and `up` from there to the next, local frame.
Footprint footprintOf(const Simulation& simulation, const WorldState& state, const Hit& hit, const glm::dvec3& ray, const glm::dvec3& across,
                      const glm::dvec3& up);

/// Whether a ray meets an entity at all, whatever hides it.
bool meetsBody(const Simulation& simulation, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, double nearest, int entity);

/// Where a ray meets the plane of a triangle that is known to be seen.
Hit hitOf(const Simulation& simulation, const WorldState& state, const glm::dvec3& origin, const glm::dvec3& direction, int entity, std::uint32_t triangle);

}  // namespace pitviper
