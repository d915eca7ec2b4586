#pragma once
// The contract of a sensor's stage: what optics, a detector or electronics make of a camera's pictures.
#include <cstdint>
#include <string>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/model/count_marks.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// What it is the picture of.
struct SensorTick {
  int frame = 0;
  double time_s = 0.0, exposure_s = 0.0;
  double step_s = 1.0;                            ///< from frame to frame
  double axis_sr = 0.0;                           ///< projected solid angle of a pixel of the film on the axis, at this time
  double focalLength_m = 0.0;                     ///< at this time; 0: the camera's own
  std::uint64_t seed = 0;                         ///< of the scenario and this camera
  double gain = 1.0;                              ///< factor of the detector's own, at this time
  std::uint64_t noise = 0;                        ///< another draw of all that changes from frame to frame; what is fixed stays the seed's
  ChannelValues exposures_s = {}, gains = {1.0};  ///< of all channels: exposure_s and gain are of those that a stage sees
};

/// Light of what is smaller than a cell.
struct SensorPoint {
  double column = 0.0, row = 0.0;  ///< cells from the top left corner of the pictures, margin and all
  std::size_t output = 0;
  double value = 0.0;  ///< in the output's unit; of outputs that are means over a cell times its projected solid angle
};

/// A picture of each of a camera's outputs in its unit, on cells: row 0 is the film's top, with the margin around it. They are where a stage wants them, on
/// the GPU or in memory, and moved only where the next one wants them elsewhere.
class SensorPictures {
 public:
  /// `outputs` must outlive it. Needs a current GlContext only where a stage asks for pictures on the GPU.
  SensorPictures(const std::vector<ChannelOutput>& ofOutputs, int columns, int rows, int cellsOfPixel, int marginAround_px)
      : outputs(ofOutputs), width(columns), height(rows), cells(cellsOfPixel), margin_px(marginAround_px), values_(ofOutputs.size()) {}
  const std::vector<ChannelOutput>& outputs;
  const int width, height;     ///< cells
  const int cells, margin_px;  ///< cells a side of a pixel; pixels around the film

  /// Not in the pictures yet: the first stage that takes points puts them there. Others may move them.
  std::vector<SensorPoint> points;
  /// Projected solid angle of each cell [sr]; null: not told.
  const std::vector<double>* cellWeights = nullptr;
  /// Of each output what the sensor itself has sent to each pixel, in its unit; empty: nothing, or not asked for.
  std::vector<std::vector<float>> ownLight;
  /// Of each channel that a detector counts, why pixels' counts say nothing.
  CountMarks marks;
  /// What a share of a point's value is in a cell.
  double inCell(const SensorPoint& p, std::size_t cell) const {
    return outputs[p.output].perEtendue || !cellWeights ? p.value : p.value / (*cellWeights)[cell];
  }

  /// In memory, row by row, to be read and written.
  std::vector<float>& values(std::size_t output);
  /// On the GPU: a stage reads `now` and draws `next`; advance() makes that the pictures.
  const Texture2D& now(std::size_t output);
  RenderTarget& next(std::size_t output);
  void advance() { std::swap(now_, next_); }

 private:
  void toGpu();
  std::vector<std::vector<float>> values_;
  std::vector<RenderTarget> now_, next_;
  bool onGpu_ = false;
};

class SensorStage {
 public:
  virtual ~SensorStage() = default;
  /// Makes its pictures of those there are.
  virtual void run(const SensorTick& tick, SensorPictures& pictures) = 0;
};

/// A stage that is a function of a picture at each cell by itself: a .glsl file with
///   float stageAt(ivec2 at)
/// that reads cell(ivec2 at) (beyond the picture its edge), parameters[k], cellsPerPixel, frameNumber.
class FormulaStage final : public SensorStage {
 public:
  /// `parameters`: at most 16.
  FormulaStage(const ShaderLibrary& library, const std::string& file, std::vector<float> parameters);
  void run(const SensorTick& tick, SensorPictures& pictures) override;

 private:
  std::vector<float> parameters_;
  Program program_;
  VertexArray empty_;
};

}  // namespace pitviper
