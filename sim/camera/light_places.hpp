#pragma once
// Where within a subpixel the light of a small body is.
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace pitviper {

/// Sums over samples of weight times place, from a subpixel's middle: x, y, x^2, x y, y^2.
using Moments = std::array<double, 5>;
void addMoments(Moments& moments, const glm::dvec2& at, double weight);

/// Where the light of some samples is: its middle, and the spread around it.
struct Place {
  glm::dvec2 middle{0.0};
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// Of sums over samples and their moments, none where these are of no place within a subpixel: what is brighter and what is darker than the rest may cancel.
std::optional<Place> placeOf(double sum, const Moments& moments);

/// Points of equal light that have a place's spread, from its middle: one where it has none, else four.
std::vector<glm::dvec2> pointsOf(const Place& place);

}  // namespace pitviper
