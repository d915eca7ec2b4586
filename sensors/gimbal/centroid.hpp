#pragma once
// A plain centroid tracker on pictures of counts or radiance: background, noise, threshold, centre of what is above it. Positions are pixels from the top
// left corner of the picture: the middle of the first pixel is (0.5, 0.5).
#include <glm/glm.hpp>
#include <limits>
#include <span>

namespace pitviper {

/// Where to look: pixels whose middle lies within half_px of the centre, or the whole picture.
struct Gate {
  bool whole = true;
  glm::dvec2 centre_px{0.0}, half_px{0.0};
};

struct ThresholdRule {
  /// Of the whole picture, or of a frame 4 pixels wide around the gate (where fewer than 64 pixels of that have values: of the picture).
  enum class Background { Picture, GateBorder };
  Background background = Background::Picture;
  /// The threshold lies so many deviations of the noise above the background. 5 is Rose's criterion (A. Rose, "Vision: Human and Electronic", Plenum 1973): in
  /// normal noise a pixel passes it with a probability of 2.9e-7, 1.9 % of pictures of 256 x 256 and 3e-4 of gates of 32 x 32 have one.
  double sigmas = 5.0;
  double leastNoise = 0.0;   ///< [the picture's unit]; for counts 0.289, the deviation of rounding, where the picture's own noise may be less
  double shareOfPeak = 0.0;  ///< the threshold lies at least so far from background to peak, 0 to 1
  int leastPixels = 1;       ///< fewer above the threshold are no target
  double saturation = std::numeric_limits<double>::infinity();  ///< [the picture's unit]; what is above counts as this
};

struct Centroid {
  bool found = false;
  glm::dvec2 at_px{0.0};    ///< mean position of the pixels above the threshold, by how far they are above it: a pixel that just passes does not pull
  glm::dvec2 peak_px{0.0};  ///< middle of the brightest pixel above the threshold
  double signal = 0.0;      ///< their sum above the background
  int pixels = 0;           ///< above the threshold
  int saturated = 0;        ///< of these at the saturation or beyond
  double background = 0.0, noise = 0.0, threshold = 0.0;
};

/// Background: the median. Noise: the median absolute deviation from it times 1.4826, the deviation where the noise is normal (P. J. Rousseeuw and C. Croux,
/// "Alternatives to the median absolute deviation", J. Am. Stat. Assoc. 88, 1273 (1993), section 1). Both from at most 4096 pixels spread evenly over the
/// picture, so that they are good to 0.02 of the deviation and 2 % (median pi/2, median absolute deviation 2.72 times the variance of the moments: the same
/// source). Where more than half the pixels have one value the noise is leastNoise.
/// Pixels that are no finite numbers count nowhere. The picture has rows from the top. Errors: std::invalid_argument for a picture of another size.
Centroid centroidOf(std::span<const float> picture, int width, int height, const Gate& gate, const ThresholdRule& rule = {});

struct TrackerOptions {
  ThresholdRule rule;
  glm::dvec2 gateHalf_px{16.0, 16.0};
  int reacquireAfter = 5;  ///< pictures without a target in the gate, after which the whole picture is searched again
};

/// A gate that follows. It begins with the whole picture: there the gate is put on the brightest pixel above the threshold.
class CentroidTracker {
 public:
  explicit CentroidTracker(const TrackerOptions& options = {}) : options_(options) {}
  Centroid look(std::span<const float> picture, int width, int height);
  /// Where the target is expected in the next picture, as the camera has turned; without, where it was found last.
  void expectAt(const glm::dvec2& at_px);
  bool locked() const { return !gate_.whole && missed_ == 0; }  ///< found in the last picture
  bool searches() const { return gate_.whole; }                 ///< the next picture as a whole
  const Gate& gate() const { return gate_; }

 private:
  TrackerOptions options_;
  Gate gate_;
  int missed_ = 0;
};

}  // namespace pitviper
