#pragma once
// A sensor's stages as a scenario asks for them: what becomes of a camera's pictures after the spectral integral.
#include <functional>
#include <memory>

namespace pitviper {

class SensorStage;
class ShaderLibrary;
struct Camera;

/// A stage of a camera; its contract is in sim/camera/sensor_stage.hpp.
struct StageChoice {
  int margin_px = 0;  ///< how far beyond a pixel it looks: so much is drawn around the film
  int cells = 1;      ///< cells a side of a pixel that it needs
  std::function<std::unique_ptr<SensorStage>(const ShaderLibrary&)> make;
};

/// The camera whose pictures its stages take: with their margins around its film, and as many cells a pixel as any of them needs. Without stages itself.
Camera drawnCamera(const Camera& camera);
/// Of all its stages: margins add up, the finest cells count.
int marginOf(const Camera& camera);
int cellsOf(const Camera& camera);

}  // namespace pitviper
