#pragma once
// A sensor's stages as a scenario asks for them: what becomes of a camera's pictures after the spectral integral.
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pitviper {

class SensorStage;
struct ChannelOutput;
class ShaderLibrary;
struct Camera;

/// How a detector makes counts: count = round(gain x min(well, electrons) + offset), 0 to 2^bits - 1. Noises are standard deviations [electron], named as
/// in EMVA 1288 and in the three-dimensional noise model (t: from frame to frame, v: from row to row, h: from column to column).
struct DetectorLaw {
  double fillFactor = 1.0;
  double darkCurrent_per_s = 0.0;  ///< [electron/s]
  double fullWell = 1e6;           ///< [electron]
  double gain = 0.01;              ///< [count/electron]
  double offset = 0.0;             ///< [count]
  int bits = 14;
  double sigmaTvh = 0.0, sigmaTv = 0.0, sigmaTh = 0.0, sigmaT = 0.0;  ///< temporal: read noise, of rows, of columns, of the frame
  double sigmaVh = 0.0, sigmaV = 0.0, sigmaH = 0.0;                   ///< fixed: of pixels (DSNU), rows, columns
  double prnu = 0.0;                                                  ///< of the response, relative
  double badPixels = 0.0;                                             ///< share that is dead or hot, half and half
  double mostCount() const { return static_cast<double>((1 << bits) - 1); }
  /// Electrons at which it no longer tells: the well is full, or the highest count.
  double saturation() const { return std::min(fullWell, (mostCount() - offset) / gain); }
};

/// A stage of a camera; its contract is in sim/camera/sensor_stage.hpp.
struct StageChoice {
  std::string name = {};
  std::string fingerprint = {};              ///< of all that it was asked for
  int margin_px = 0;                         ///< how far beyond a pixel it looks: so much is drawn around the film
  int cells = 1;                             ///< cells a side of a pixel that it needs
  bool onPixels = false;                     ///< of the detector: it takes the film's own pixels, after every stage that takes cells
  std::optional<DetectorLaw> detector = {};  ///< it makes counts of photoelectrons
  /// Contrast it leaves of a channel's pattern of this frequency on the film [1/m]; none: all.
  std::function<double(const ChannelOutput& output, double frequency_per_m)> transfer = {};
  /// The same of what its cells make of it.
  std::function<double(const ChannelOutput& output, double frequency_per_m)> drawnTransfer = {};
  std::function<std::unique_ptr<SensorStage>(const ShaderLibrary&)> make = {};
};

/// The camera whose pictures its stages take: with their margins around its film, and as many cells a pixel as any of them needs. Without stages itself.
Camera drawnCamera(const Camera& camera);
/// Of all its stages: margins add up, the finest cells count.
int marginOf(const Camera& camera);
int cellsOf(const Camera& camera);

}  // namespace pitviper
