#pragma once
// A rectangle of film seen from a point: a camera's image, or the zoomed view of a small body.
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "sim/world/world.hpp"

namespace pitviper {

/// Camera axes: x right, y up, looking along -z. Film positions in tangents from the axis; pixel (0, 0) is the lower left, as
/// GL has it.
struct View {
  int width = 0, height = 0;  ///< pixels (of the target, subpixels counted)
  double tanPerPixelX = 0.0, tanPerPixelY = 0.0;
  double axisX = 0.0, axisY = 0.0;  ///< film position of the axis [pixels from the lower left corner]
  glm::dvec3 position{0.0};         ///< local frame
  glm::dmat3 localFromCamera{1.0};
  double near_m = 0.1;
  bool zoomed = false;                              ///< many pixels on a small body
  int onlyEntity = -1;                              ///< shade this entity alone, behind whatever hides it; -1: everything
  glm::dvec3 depthCentre{0.0};                      ///< with onlyEntity: depth has its digits around this place (local frame) ...
  double depthRadius_m = 1.0;                       ///< ... within this distance
  std::shared_ptr<const std::vector<char>> wanted;  ///< one flag per pixel, row 0 at the bottom: the others need no colour; null: all do
  int subpixels = 1;                                ///< so many by so many are a pixel of a camera, and only its pixels are read back ...
  glm::ivec4 kept{0};                               ///< ... but for this part (corner, size), in which each is
  int grouped = 1;                                  ///< so many by so many pixels may be shaded as one where they are alike
  double pixelTan2 = 0.0;                           ///< (tangent per whole pixel)^2, for the truth layer of the fragment's area

  /// Direction of a film position in camera axes, z = -1.
  glm::dvec3 ray(double x, double y) const { return {(x - axisX) * tanPerPixelX, (y - axisY) * tanPerPixelY, -1.0}; }
};

/// The whole image of a camera at n x n subpixels.
View cameraView(const Camera& camera, const WorldState& state, int samples);

/// False where a sphere lies wholly outside the four sides of a view, or behind it.
bool mayShow(const View& view, const glm::dvec3& centre, double radius_m);

/// The film position [pixels from the lower left] of a point in camera axes (z < 0).
inline glm::dvec2 filmPosition(const View& v, const glm::dvec3& p) { return {v.axisX + p.x / -p.z / v.tanPerPixelX, v.axisY + p.y / -p.z / v.tanPerPixelY}; }

}  // namespace pitviper
