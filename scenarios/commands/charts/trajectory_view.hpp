#pragma once
// How a scene of trajectories lies on its picture: what box it fills, how many times higher heights are drawn, from where it is looked at. Parallel projection:
// equal lengths along an axis are equal everywhere, so that they can be read off.
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "scenarios/commands/trajectory_picture.hpp"

namespace pitviper {

/// A part of the picture [px from the top left].
struct PictureArea {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;
};

class TrajectoryView {
 public:
  /// `places`: all that must be seen, finite, one at least.
  TrajectoryView(const std::vector<glm::dvec3>& places, const PictureArea& area);

  const glm::dvec3& low_m() const { return low_; }
  const glm::dvec3& high_m() const { return high_; }
  double exaggeration() const { return exaggeration_; }  ///< of heights; 1: to the scale of the ground
  /// Where VTK draws a place: in pixels about the middle of the box.
  glm::dvec3 drawn(const glm::dvec3& place_m) const;
  /// Where it is on the picture [px from the top left].
  glm::dvec2 onPicture(const glm::dvec3& place_m) const { return projected(drawn(place_m)); }
  /// A point of the picture before (in front of) everything, for VTK.
  glm::dvec3 inFront(const glm::dvec2& picture_px) const;
  glm::dvec3 atCorner(bool east, bool north, bool up) const { return {east ? high_.x : low_.x, north ? high_.y : low_.y, up ? high_.z : low_.z}; }
  /// Of a vertical wall or a side of the floor: whether the high one of two is nearer to who looks.
  bool eastIsNear() const { return back_.x > 0.0; }
  bool northIsNear() const { return back_.y > 0.0; }
  const glm::dvec3& right() const { return right_; }
  const glm::dvec3& up() const { return up_; }
  const glm::dvec3& back() const { return back_; }  ///< towards who looks
  /// Farther than anything of the box is from its middle [px].
  double reach_px() const { return reach_; }

 private:
  glm::dvec2 projected(const glm::dvec3& drawn) const { return {origin_.x + glm::dot(drawn, right_), origin_.y - glm::dot(drawn, up_)}; }
  void turn(double azimuth_rad);
  glm::dvec3 low_{0.0}, high_{1.0}, middle_{0.0};
  double exaggeration_ = 1.0, pixelsPer_m_ = 1.0, reach_ = 1.0;
  glm::dvec3 right_{1, 0, 0}, up_{0, 0, 1}, back_{0, -1, 0};
  glm::dvec2 origin_{0.0};
};

}  // namespace pitviper
