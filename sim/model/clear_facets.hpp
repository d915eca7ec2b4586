#pragma once
// Facets that nothing of their own body shades from a light far away: of a body that stands still under the sun nobody has to look again.
#include <vector>

#include "sim/scene/mesh.hpp"

namespace pitviper {

/// Of each triangle: 1 where it faces the light and, seen from there, no other triangle of the mesh lies over any part of it nearer to the light. Exact but for
/// rounding in double precision; triangles that touch it along edges and corners don't count. None of a mesh of
/// which too many triangles lie side by side in both directions (fans of long ones, details far smaller than the rest). `toLight`: unit, body axes.
std::vector<char> clearFacets(const Mesh& mesh, const glm::dvec3& toLight);

}  // namespace pitviper
