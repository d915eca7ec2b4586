#pragma once
// What a stream says of a frame besides its pixels: whose turn it was, when, from where.
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace pitviper {

/// Times ending in `_tai_ns` are of the wall clock, TAI since 1970 [ns]; the others simulation time [ns].
struct FrameStamp {
  std::uint64_t sequence = 0;   ///< ticks of the stream from 0: one that is left out was dropped
  std::uint64_t hostFrame = 0;  ///< number that the host's last command gave; 0: none
  std::int64_t time_ns = 0, exposureStart_ns = 0, exposureEnd_ns = 0;
  std::int64_t renderStart_tai_ns = 0, renderEnd_tai_ns = 0;  ///< its picture was begun, and is there with all that sensors do
  std::int64_t due_tai_ns = 0;                                ///< 0: nothing is late in lockstep
  std::int64_t poseAge_ns = -1;                               ///< between the arrival of the last command that it has and renderStart; -1: it has none
  std::uint64_t dropped = 0, late = 0, repeated = 0;          ///< frames of this stream so far, this one counted
  bool isLate = false, isRepeated = false, isOutsideLimits = false;
  double gain = 1.0;                            ///< factor of its detector's
  double accuracy = 0.0, predictedError = 0.0;  ///< relative: asked of its plan (0: none asked), and what that expects of the worst channel
  glm::dvec3 position_ecef_m{0.0};
  glm::dquat orientation_ecef{1.0, 0.0, 0.0, 0.0};  ///< of the camera's body axes: x is the line of sight, y left, z up
  glm::dvec3 sight_ecef{0.0};                       ///< unit vector
  double latitude_deg = 0.0, longitude_deg = 0.0, height_m = 0.0;
  double column_px = 0.0, row_px = 0.0;  ///< where the middle of what it looks at, or else of the first body, is in the picture [pixels]; NaN behind it
};

}  // namespace pitviper
