#pragma once
// All that is between a world and the frames of one camera: its pictures, its sensor, its truth, its audit.
#include <memory>
#include <optional>
#include <vector>

#include "sim/camera/audit.hpp"
#include "sim/camera/camera_pointer.hpp"
#include "sim/camera/exposure_parts.hpp"
#include "sim/camera/sensor_chain.hpp"
#include "sim/frame/frame.hpp"
#include "sim/frame/truth_table.hpp"

namespace pitviper {

/// A camera drawn to another accuracy.
Camera withAccuracy(const Camera& camera, double accuracy);
/// What a stream of a camera may be drawn to: the accuracy asked for, then twice that and so on up to SpectralSampling::atMost. One at least.
std::vector<double> rungsOf(const Camera& camera);

class CameraLine {
 public:
  /// The first three must outlive it. `planning`: told while plans are made. `allRungs`: not only the first of rungsOf(). Needs a current GlContext.
  CameraLine(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
             const std::function<void(double share)>& planning, bool allRungs = false);

  /// Detectors that remember see so many frames before the first, which nobody gets; a follower that looks at its own pictures all from the scenario's first
  /// on.
  void warmUp(int first);
  /// Every rung draws a picture that nobody gets: the first frame waits for no compiler.
  void prepare(const StateAt& stateAt, double time_s);

  /// Begins a frame's picture; the caller may do other work before finish(). `number`: of the frame, in rising order: what points the camera ticks; without,
  /// the camera looks as its mount has it.
  void begin(const StateAt& stateAt, double time_s, std::optional<int> number = {});
  /// Its picture. `number`: of the frame; given it is audited (`isFirst`: of its run).
  CameraImage finish(std::optional<int> audited = {}, bool isFirst = false);
  /// What the sensor makes of it, with all that is said of it. In the order of the frames. `stateAt`: for rates of targets; unless given the scenario's own
  /// world.
  Frame frame(const CameraImage& image, const WorldState& state, int number, const StateAt& stateAt = {});

  const Camera& camera() const { return camera_; }
  /// The next frame must not begin before this one's frame(): its picture says where the camera looks.
  bool looksAtItsPictures() const { return pointer_ && pointer_->looks(); }
  /// Lines of the record of what points it, since they were asked for last; none without.
  std::string takePoses() { return pointer_ ? pointer_->takeRecord() : std::string(); }
  Auditor& auditor() { return *auditor_; }
  CameraRenderer& renderer() { return *rungs_[rung_].renderer; }
  std::size_t rungs() const { return rungs_.size(); }
  std::size_t rung() const { return rung_; }
  void setRung(std::size_t rung) { rung_ = rung; }
  double accuracyOf(std::size_t rung) const { return rungs_[rung].drawn->spectral.accuracy; }

 private:
  /// What the sensor makes of a picture, with what its follower finds in that.
  Frame seen(const CameraImage& image, const WorldState& state, int number, std::vector<TargetRow> targets, std::vector<FrameLayer> terms);
  struct Rung {
    std::unique_ptr<Camera> drawn;  ///< which the renderer looks at
    std::unique_ptr<CameraRenderer> renderer;
  };
  const Simulation& simulation_;
  const Camera& camera_;
  std::vector<Rung> rungs_;
  std::size_t rung_ = 0;
  std::unique_ptr<SensorChain> chain_;  ///< null for a camera without stages
  std::unique_ptr<Auditor> auditor_;
  std::unique_ptr<TruthMeter> truth_;  ///< null for a camera that asks for none of it
  std::unique_ptr<CameraPointer> pointer_;  ///< null for a camera that its mount alone points
  bool isPointed_ = false;                  ///< the picture that was begun
  StateAt stateAt_;                    ///< of the picture that was begun
  ExposureParts parts_;
  double time_s_ = 0.0;
};

}  // namespace pitviper
