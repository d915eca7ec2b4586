#pragma once
// Lines, balls and planes in space, for a renderer of VTK's. Lengths and places are in pixels of the finished picture.
#include <glm/glm.hpp>
#include <vector>

#include "sim/image/picture.hpp"

class vtkRenderer;

namespace pitviper {

using SpaceLine = std::vector<glm::dvec3>;

/// Lines as round tubes; `shaded`: lit, so that they look round.
void addTubes(vtkRenderer& renderer, const std::vector<SpaceLine>& lines, double radius_px, Rgb8 colour, bool shaded);
void addBalls(vtkRenderer& renderer, const std::vector<glm::dvec3>& places, double radius_px, Rgb8 colour);
/// A cone whose point is at `tip`, pointing along a direction of any length.
void addCone(vtkRenderer& renderer, const glm::dvec3& tip, const glm::dvec3& along, double length_px, double radius_px, Rgb8 colour);
/// A flat polygon, its corners in order.
void addPlane(vtkRenderer& renderer, const SpaceLine& corners, Rgb8 colour);
/// A line in pieces of so many pixels, with gaps of the same length.
std::vector<SpaceLine> dashed(const glm::dvec3& from, const glm::dvec3& to, double dash_px);

}  // namespace pitviper
