#pragma once
// Frames that audit themselves: some pixels are worked out by the reference, at the subpixels the frame used, and held against it.
#include <memory>

#include "sim/camera/camera_renderer.hpp"
#include "sim/camera/whole_pixel.hpp"

namespace pitviper {

/// How many pixels of a frame are looked at for a setting of so many a frame: of 0.1 one in each tenth frame, the first among them.
int auditedPixels(double perFrame, int frame);

/// Pixels a frame that cost about a twentieth of a frame's time, from stored costs.
double affordablePixels(const Simulation& simulation, const Camera& camera, const Plan& plan);

/// What a run's audits found of a camera, all channels together.
struct AuditTally {
  int pixels = 0, frames = 0;
  std::vector<double> errors;  ///< of random pixels, every channel's
  double largest = 0.0;        ///< of random and doubtful ones
  std::string channel;         ///< where it was
  double asked = 0.0;          ///< 0: nothing was
  /// |L - Lwhole| / max(Lwhole, brightest within one pixel) of pixels looked at, every channel's: with its geometry (WholePixels).
  std::vector<double> whole;
  double wholeError = 0.0;  ///< standard error of the worst of these
};

class Auditor {
 public:
  /// As CameraRenderer; `planned` is what is audited, its simulation and camera too.
  Auditor(const Simulation& simulation, const Camera& camera, const Plan& planned, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  /// Looks at some pixels of a picture, chosen by seed, camera and frame number alone: random ones, and of many that one which sees what the fewest of
  /// them do. What it finds goes into the picture; where this frame is not to be looked at but `force` wants a pixel, into the tally alone, so that a
  /// frame does not depend on which others are drawn.
  void look(const WorldState& state, int frame, CameraImage& image, bool force);
  /// Where more was found than asked, for the plan to learn (Camera::learnt).
  const std::vector<FilmPlace>& broken() const { return broken_; }
  const AuditTally& tally() const { return tally_; }

 private:
  std::vector<int> pixelsOf(int count, int frame, std::uint64_t stream) const;
  void lookAtWhole(const WorldState& state, int pixel, const CameraImage& image);
  int doubtful(const WorldState& state, int frame) const;

  const Simulation& simulation_;
  Camera camera_;  ///< the same in reference mode
  const ShaderLibrary& library_;
  std::shared_ptr<const GpuScene> scene_;
  double perFrame_ = 0.0, asked_ = 0.0;
  std::uint64_t seed_ = 0;
  Plan planned_;
  Camera asDrawn_;
  std::unique_ptr<WholePixels> whole_;
  std::unique_ptr<CameraRenderer> reference_;  ///< once it is needed
  std::vector<FilmPlace> broken_;
  AuditTally tally_;
};

}  // namespace pitviper
