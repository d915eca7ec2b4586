#pragma once
// A sensor's stages as a scenario asks for them: what becomes of a camera's pictures after the spectral integral.
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/detector_law.hpp"

namespace pitviper {

class SensorStage;
struct ChannelOutput;
class ShaderLibrary;
struct Camera;

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
  /// Frames before one that it has to have seen, of a camera with so many seconds from frame to frame; none: none.
  std::function<int(double step_s)> warmUp_frames = {};
  bool takesPoints = false;  ///< what is smaller than a cell comes to it as points (SensorPoint), at their places
  /// Share of a point's light that falls on a pixel whose middle is so far from it [pixels], at a focal length; none: all of it on the pixel it is in.
  std::function<double(const ChannelOutput& output, double focalLength_m, double x, double y)> pixelShare = {};
  /// What the sensor itself sends to a pixel of this projected solid angle on the axis, in the output's unit (without exposure time); none: nothing.
  std::function<double(const ChannelOutput& output, double axis_sr)> ownLight = {};
  /// Where on the film light falls that a pinhole would send there: both from the axis, right and up [m]; none: there.
  std::function<glm::dvec2(const glm::dvec2& film_m, double focalLength_m)> place = {};
};

/// The camera whose pictures its stages take: with their margins around its film, and as many cells a pixel as any of them needs. Without stages itself.
Camera drawnCamera(const Camera& camera);
/// Of all its stages: margins add up, the finest cells count.
int marginOf(const Camera& camera);
int cellsOf(const Camera& camera);
/// Frames that its stages have to have seen before the first that counts.
int warmUpOf(const Camera& camera, double step_s);
/// Share of a point's light on a pixel whose middle is so far from it [pixels]: of its lens, and of what its detector's pixels share.
double pixelShareOf(const Camera& camera, const ChannelOutput& output, double focalLength_m, double x = 0.0, double y = 0.0);
/// Of all its stages, in the output's unit.
double ownLightOf(const Camera& camera, const ChannelOutput& output, double axis_sr, double exposure_s);
const DetectorLaw* detectorOf(const Camera& camera, const std::string& channel);  ///< or null
bool hasDetector(const Camera& camera);  ///< of any of its channels
/// Where a place of the picture that a pinhole would draw [pixels from the top left corner] is in that of its stages.
glm::dvec2 placeOnFilm(const Camera& camera, double focalLength_m, const glm::dvec2& column_row);

}  // namespace pitviper
