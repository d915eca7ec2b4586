#pragma once
// The law of a segment of path (sim/radiometry/glsl/segment.glsl) at many nodes at once.
#include <vector>

namespace pitviper {

/// A segment between two places of a line, per node: arrays of as many numbers as there are nodes.
struct SegmentAt {
  const double *nearDepth, *farDepth, *nearPassed, *farPassed;  ///< of the air from the eye to its ends, and what that lets through
  const double *depth, *passed;                                 ///< of the media on it, and what these let through
  const double *before, *beforePassed, *panes;                  ///< media from the eye to it, and what they and panes let through
  double opaque;                                                ///< nothing is seen of what lies beyond such a depth
};

/// What it lets out towards the eye of what is sent on it.
class SegmentLaw {
 public:
  void set(const SegmentAt& at, std::size_t count);
  // Each is added to `into` [W/(m2 sr um)].
  /// Of media: `emitted`, source x depth in the middle, and `drifting`, what that changes by from the near end to the far one.
  void addMedia(const double* emitted, const double* drifting, double* into) const;
  /// Of air: sources of its temperature at both ends, and one that is the same everywhere.
  void addAir(const double* near, const double* far, const double* everywhere, double* into) const;
  /// Of sunlight once turned: `scale` x irradiance x what the segment turns, seen through air to its place and from there to the sun (depths at both ends, and
  /// what they let through).
  struct SunAt {
    const double *nearDepth, *farDepth, *nearPassed, *farPassed, *irradiance, *turned;
  };
  void addSun(double scale, const SunAt& sun, double* into) const;

 private:
  SegmentAt at_{};
  std::size_t count_ = 0;
  std::vector<double> air_, lost_, growth_, reach_, each_;  ///< depth of its air; of its whole depth; what is seen of it, and that for each depth
};

}  // namespace pitviper
