#pragma once
// The box around trajectories: floor, walls behind, numbers along three edges. And what is written on the picture, once it is drawn.
#include <string>
#include <vector>

#include "scenarios/commands/charts/trajectory_view.hpp"
#include "sim/image/picture.hpp"

class vtkRenderer;

namespace pitviper {

struct PictureLabel {
  std::string text;
  glm::dvec2 at_px{0.0};  ///< the middle of its height
  double anchor = 0.0;    ///< 0: `at` is its left end, 0.5 its middle, 1 its right end
  int size_px = 13;
  Rgb8 colour{40, 40, 40};
  bool bold = false;
};

class PictureLabels {
 public:
  void add(const PictureLabel& label) { labels_.push_back(label); }
  /// Unless it would lie over another. Whether it was.
  bool addIfFree(const PictureLabel& label);
  void write(Rgb8Image& picture) const;

 private:
  std::vector<PictureLabel> labels_;
};

/// "5 km" and the like: of lengths on the axes. Kilometres where the box is longer than 5 km.
struct LengthUnit {
  double metres = 1.0;
  std::string name = "m";
};
LengthUnit unitOf(const TrajectoryView& view);

void addAxes(vtkRenderer& renderer, const TrajectoryView& view, PictureLabels& labels);

}  // namespace pitviper
