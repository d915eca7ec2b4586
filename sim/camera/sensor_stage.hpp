#pragma once
// The contract of a sensor's stage: what optics, a detector or electronics make of a camera's pictures, which stay on the GPU from one to the next.
#include <string>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// What it is the picture of.
struct SensorTick {
  int frame = 0;
  double time_s = 0.0, exposure_s = 0.0;
};

/// A picture of each of a camera's outputs in its unit, on cells: row 0 is the film's top, with the margin around it.
struct SensorPictures {
  const std::vector<ChannelOutput>& outputs;
  int cells = 1, margin_px = 0;  ///< cells a side of a pixel; pixels around the film
  std::vector<RenderTarget> now, next;
  /// What a stage has drawn becomes what the next one takes.
  void advance() { std::swap(now, next); }
};

class SensorStage {
 public:
  virtual ~SensorStage() = default;
  /// Takes `now`, leaves its pictures there (SensorPictures::advance()).
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
