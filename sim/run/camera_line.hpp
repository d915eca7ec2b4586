#pragma once
// All that is between a world and the frames of one camera: its pictures, its sensor, its truth, its audit.
#include <memory>
#include <optional>
#include <vector>

#include "sim/camera/camera_pointer.hpp"
#include "sim/camera/exposure_parts.hpp"
#include "sim/camera/sensor_chain.hpp"
#include "sim/frame/frame.hpp"
#include "sim/frame/truth_table.hpp"
#include "sim/run/camera_drawing.hpp"

namespace pitviper {

class CameraLine {
 public:
  /// As CameraDrawing, of the thread's context. `allRungs`: not only the first of rungsOf(). `isDraft`: by a draft alone, until takeOver().
  CameraLine(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, const std::shared_ptr<const GpuScene>& scene,
             const std::function<void(double share)>& planning, bool allRungs = false, bool isDraft = false);
  /// By a drawing at hand, of the thread's context or its own.
  CameraLine(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::unique_ptr<CameraDrawing> drawing, bool isDraft);
  /// What draws from here on; no picture may be begun.
  void takeOver(std::unique_ptr<CameraDrawing> drawing);
  bool isDraft() const { return isDraft_; }

  /// Detectors that remember see so many frames before the first, which nobody gets; a follower that looks at its own pictures all from the scenario's first
  /// on.
  void warmUp(int first, const StateAt& stateAt = {});
  /// As if `first` were the first frame: what detectors and followers remember is forgotten.
  void startAgain(int first, const ShaderLibrary& library, const StateAt& stateAt = {});
  /// Another draw of the detector's noise in frames to come; 0: the scenario's own.
  void setNoise(std::uint64_t noise) {
    if (chain_) chain_->setNoise(noise);
  }
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
  Auditor& auditor() { return drawing_->auditor(); }
  CameraRenderer& renderer() { return drawing_->renderer(rung_); }
  std::size_t rungs() const { return drawing_->rungs(); }
  std::size_t rung() const { return rung_; }
  void setRung(std::size_t rung) { rung_ = rung; }
  double accuracyOf(std::size_t rung) const { return drawing_->accuracyOf(rung); }

 private:
  void makeSensor(const ShaderLibrary& library);
  /// What the sensor makes of a picture, with what its follower finds in that.
  Frame seen(const CameraImage& image, const WorldState& state, int number, std::vector<TargetRow> targets, std::vector<FrameLayer> terms);
  const Simulation& simulation_;
  const Camera& camera_;
  std::unique_ptr<CameraDrawing> drawing_;
  std::size_t rung_ = 0;
  bool isDraft_;
  std::unique_ptr<SensorChain> chain_;      ///< null for a camera without stages
  std::unique_ptr<TruthMeter> truth_;       ///< null for a camera that asks for none of it
  std::unique_ptr<CameraPointer> pointer_;  ///< null for a camera that its mount alone points
  bool isPointed_ = false;                  ///< the picture that was begun
  StateAt stateAt_;                         ///< of the picture that was begun
  ExposureParts parts_;
  double time_s_ = 0.0;
};

}  // namespace pitviper
