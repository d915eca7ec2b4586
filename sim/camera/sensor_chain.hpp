#pragma once
// Runs a camera's stages over what was drawn of it: those of the optics on cells, then, cells brought together into pixels, those of the detector.
#include <memory>
#include <optional>

#include "sim/camera/sensor_stage.hpp"

namespace pitviper {

class SensorChain {
 public:
  /// Both must outlive it; the camera has stages. Needs a current GlContext.
  SensorChain(const Camera& camera, const ShaderLibrary& library);
  /// `drawn`: of each output a picture of drawnCamera(), row by row from the top, in its unit; `cellWeights`: projected solid angle of each of
  /// its cells, which means of intensive outputs are weighted by (those per etendue add up); `points`: what is smaller than a cell, for stages that take it
  /// (drawnCamera() has pointsApart). Returns pictures of the camera's own pixels.
  std::vector<std::vector<float>> run(std::vector<std::vector<float>> drawn, const std::vector<double>& cellWeights, const SensorTick& tick,
                                      std::vector<SensorPoint> points = {});
  /// Of an output per etendue: what an even field of radiance gives each pixel, as a projected solid angle, through all of the optics; as a calibration would find it. Of the last
  /// tick that was run.
  const std::vector<double>& seenSolidAngles(std::size_t output) const { return seen_[output]; }
  /// Pixels whose counts say nothing, of the last tick that was run.
  const CountMarks& marks() const { return pixels_.marks; }
  /// The cell in the middle of a pixel of the camera, in pictures of drawnCamera().
  std::size_t middleCell(int column, int row) const;

 private:
  std::vector<float> resolved(std::vector<float> cells, const std::vector<double>& weights, bool addsUp) const;
  const Camera& camera_;
  SensorPictures cells_, pixels_;
  /// What even fields and none give, at a focal length and exposure: for those outputs that are told as temperatures.
  void calibrate(const std::vector<double>& cellWeights, const SensorTick& tick);
  double calibratedFocal_m_ = -1.0, calibratedExposure_s_ = -1.0;
  std::vector<std::vector<double>> seen_;
  struct Named {
    std::string part;  ///< for timing
    std::unique_ptr<SensorStage> stage;
  };
  static void run(const std::vector<Named>& stages, const SensorTick& tick, SensorPictures& pictures);
  std::vector<Named> ofCells_, ofPixels_;
};

}  // namespace pitviper
