#pragma once
// On how many lines of sight a plan is made and measured. A sketch is worth fewer: its groups have much room, and its picture is wanted at once.
namespace pitviper {

struct PlanEffort {
  int first, check;  ///< of the first fit, besides the extremes, and of each check
  int second;        ///< on which fits are held against the equation after that, besides the extremes
  /// Drawn as the film draws them and seen by no fit, they measure what a plan is off by: with 95 % certainty at most 3 of n pixels are off by more than the
  /// worst of n lines.
  int last;
  int lastSmall;  ///< as many again of small bodies, which the film draws in views of their own
  /// The largest error on these times this is predicted, as a film has many more pixels. Of 235 cells of random scenes (seeds 6001 to 6099) two were off by
  /// more than a margin of 2 or of 1.5 had predicted on the usual lines, one with 2.5.
  double margin;
  int floorFrames, floor;  ///< frames in which the film's darkness is looked for, and lines in all of them
  int around;              ///< on which light from all around is chosen
  /// Floors, harmonics and places of air are chosen on so many wavelengths of each channel: with 8 or 400 floors and losses are the same within 3 % in scenes
  /// from the visible to 14 um.
  int lookedAt;
};

inline constexpr PlanEffort kUsualEffort{600, 360, 400, 1000, 300, 2.0, 24, 240, 240, 16}, kSketchEffort{120, 90, 80, 250, 60, 3.0, 8, 96, 60, 8};
/// From this accuracy on a picture is a sketch.
inline constexpr double kSketch = 0.08;

/// `accuracy`: of a plan; 0: none was asked for, and lines only tell what it is off by.
inline const PlanEffort& effortOf(double accuracy) { return accuracy >= kSketch ? kSketchEffort : kUsualEffort; }

}  // namespace pitviper
