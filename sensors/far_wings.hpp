#pragma once
// Light that a lens sends far, on a grid coarser than the picture's cells: it changes slowly there, so that few places tell all of it, at any distance.
#include <vector>

#include "sensors/lens_spread.hpp"
#include "sensors/plane_transform.hpp"

namespace pitviper {

/// Adds the sum over places s of light(s) (1 - cut(r)) wing / r^3, r = |cell - s|. Light goes to the grid's places, and comes back from them, by Lagrange's
/// cubic through four neighbours each way, whose error is of the fourth order of the grid's step over the distance at which `cut` begins.
class FarWings {
 public:
  FarWings(const LensSpread& spread, int width, int height);
  /// Light of a picture less a level, and of points; gathered until spread().
  void gather(const std::vector<float>& picture, double level);
  void gather(double column, double row, double light);
  /// What has been gathered, added to each cell; nothing is gathered then.
  void spread(std::vector<double>& cells);

 private:
  struct Place {
    int first = 0;  ///< of four nodes
    double weight[4] = {0.0, 0.0, 0.0, 0.0};
  };
  Place placeOf(double cell) const;
  int width_, height_, step_, columns_, rows_;
  PlaneTransform transform_;
  std::vector<double> transfer_, light_;
  std::vector<Place> ofColumn_, ofRow_;  ///< of cells' middles
};

}  // namespace pitviper
