#pragma once
// An exposure as several pictures of one frame: what moves while a film, or one row of it after the other, is exposed.
#include <functional>
#include <vector>

#include "sim/camera/camera_renderer.hpp"

namespace pitviper {

/// A frame's exposure lies around its time t: from t - T/2 to t + T/2; of a rolling read-out row r of the film begins (r - middle row) line times later.
/// It is a mean of pictures at K times, evenly over all of that: each counts for the times nearest to it; where rows are exposed at one time only (no motion
/// blur), a row lies between the two nearest. Law of K: what moves by m pixels in all is off by at most m / (4 K^2) of its contrast where the light of an
/// exposure is added up, m / (4 K) where rows lie between two pictures (a pixel's share of a moving edge is linear but where the edge enters and leaves it;
/// the midpoint rule's error there). What is smaller than a pixel leaves n or n + 1 pictures in each pixel of its way, n = K / m of m pixels: off by m / K at
/// most; four pictures a pixel at least are drawn of it. Channels that are exposed for less than the longest of them take those of its times, and parts of
/// them, that they are exposed for: their share of the motion and of the pictures falls alike, so that the shortest, T / T' of the longest, is off by m T / (4
/// K^2 T').
struct ExposureParts {
  std::vector<double> times_s;
  std::vector<std::size_t> timingOfOutput;  ///< into the next, of each of the camera's outputs
  /// Of outputs that are exposed and read out alike: of each time, for each row of the picture; empty: all alike.
  std::vector<std::vector<std::vector<double>>> rowWeights;
  double motion_px = 0.0;       ///< over all of it, of the film's pixels
  double smallMotion_px = 0.0;  ///< of what is smaller than two pixels: lamps, small bodies
  double error = 0.0;           ///< expected, of an edge's contrast
  double streakError = 0.0;     ///< the same of the streak that a small thing leaves, of its own brightness
};

/// `camera`: the film's; the pictures are drawnCamera()'s. One part, at the frame's time, unless the camera has motion blur or its detector a line time.
ExposureParts exposureParts(const Simulation& simulation, const Camera& camera, const StateAt& stateAt, double time_s);

/// Draws the parts with a renderer of drawnCamera() and takes their mean; truth is of the part in the middle. `looked`: gets that part's own picture, before;
/// what it adds to the picture of an audit is kept.
CameraImage renderExposure(CameraRenderer& renderer, const Simulation& simulation, const Camera& camera, double time_s,
                           const std::function<void(const WorldState&, CameraImage&)>& looked = {});
/// The same of a world that is not the scenario's alone.
CameraImage renderParts(CameraRenderer& renderer, const ExposureParts& parts, const StateAt& stateAt,
                        const std::function<void(const WorldState&, CameraImage&)>& looked = {});

}  // namespace pitviper
