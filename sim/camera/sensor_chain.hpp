#pragma once
// Runs a camera's stages over what was drawn of it: those of the optics on cells, then, cells brought together into pixels, those of the detector.
#include <memory>
#include <optional>

#include "sim/camera/sensor_stage.hpp"

namespace pitviper {

/// The stages of outputs that have the same ones, and the same exposure.
class StageLine {
 public:
  /// `outputs`: of the camera; `cells`, `margin_px`: of its drawn pictures. The camera must outlive it. Needs a current GlContext.
  StageLine(const Camera& camera, std::vector<ChannelOutput> outputs, const std::vector<StageChoice>& stages, const ShaderLibrary& library);
  const std::vector<ChannelOutput>& outputs() const { return outputs_; }
  /// As SensorChain::run(), of its outputs.
  std::vector<std::vector<float>> run(std::vector<std::vector<float>> drawn, const std::vector<double>& cellWeights, const SensorTick& tick,
                                      std::vector<SensorPoint> points);
  const std::vector<double>& seenSolidAngles(std::size_t output) const { return seen_[output]; }
  const CountMarks& marks() const { return pixels_.marks; }

 private:
  std::vector<float> resolved(std::vector<float> cells, const std::vector<double>& weights, bool addsUp) const;
  /// What even fields and none give, at a focal length and exposure: for those outputs that are told as temperatures.
  void calibrate(const std::vector<double>& cellWeights, const SensorTick& tick);
  struct Named {
    std::string part;  ///< for timing
    std::unique_ptr<SensorStage> stage;
  };
  static void run(const std::vector<Named>& stages, const SensorTick& tick, SensorPictures& pictures);
  const Camera& camera_;
  const std::vector<ChannelOutput> outputs_;
  SensorPictures cells_, pixels_;
  double calibratedFocal_m_ = -1.0, calibratedExposure_s_ = -1.0;
  std::vector<std::vector<double>> seen_;
  std::vector<Named> ofCells_, ofPixels_;
};

class SensorChain {
 public:
  /// Both must outlive it; the camera has stages. Needs a current GlContext.
  SensorChain(const Camera& camera, const ShaderLibrary& library);
  /// `drawn`: of each output a picture of drawnCamera(), row by row from the top, in its unit; `cellWeights`: projected solid angle of each of
  /// its cells, which means of intensive outputs are weighted by (those per etendue add up); `points`: what is smaller than a cell, for stages that take it
  /// (drawnCamera() has pointsApart). Returns pictures of the camera's own pixels.
  std::vector<std::vector<float>> run(std::vector<std::vector<float>> drawn, const std::vector<double>& cellWeights, const SensorTick& tick,
                                      std::vector<SensorPoint> points = {});
  /// Of an output per etendue: what an even field of radiance gives each pixel, as a projected solid angle, through all of the optics; as a calibration would
  /// find it. Of the last tick that was run.
  const std::vector<double>& seenSolidAngles(std::size_t output) const { return lines_[places_[output].line]->seenSolidAngles(places_[output].output); }
  /// Another draw of the noise of pictures to come (SensorTick::noise); 0: the scenario's own.
  void setNoise(std::uint64_t noise) { noise_ = noise; }
  std::uint64_t noise() const { return noise_; }
  /// Pixels whose counts say nothing, of the last tick that was run.
  CountMarks marks() const;
  /// The cell in the middle of a pixel of the camera, in pictures of drawnCamera().
  std::size_t middleCell(int column, int row) const;

 private:
  struct Place {
    std::size_t line, output;  ///< the second: among the line's
  };
  int width_, cells_, margin_px_;  ///< cells of a row
  std::uint64_t noise_ = 0;
  std::vector<std::unique_ptr<StageLine>> lines_;
  std::vector<Place> places_;  ///< of the camera's outputs
};

}  // namespace pitviper
