#pragma once
// Facets that nothing which stands still shades from a light far away: of bodies that stand still under the sun nobody has to look again.
#include <span>
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Another body that may stand before the light; a point of it is axes * p + origin in the axes of the first.
struct Occluder {
  const Mesh& mesh;
  glm::dmat3 axes{1.0};
  glm::dvec3 origin{0.0};
};

/// Of each triangle: 1 where it faces the light and, seen from there, no other triangle of the mesh or of the others lies over any part of it nearer to the
/// light. Exact but for rounding in double precision; triangles that touch it along edges and corners don't count. None of a mesh of which too many triangles
/// lie side by side in both directions (fans of long ones, details far smaller than the rest). `toLight`: unit, body axes.
std::vector<char> clearFacets(const Mesh& mesh, const glm::dvec3& toLight, std::span<const Occluder> others = {});

/// The same, from the cache of tables where it was found before.
std::vector<char> keptClearFacets(const Mesh& mesh, const glm::dvec3& toLight, std::span<const Occluder> others);

}  // namespace pitviper
