#pragma once
// A calibrated frame: what leaves the renderer, with everything needed to use it without the scenario at hand.
#include <map>
#include <string>
#include <vector>

#include "sim/image/exr.hpp"
#include "sim/model/simulation.hpp"
#include "sim/render/camera_renderer.hpp"

namespace pitviper {

/// One image in one unit: row-major, row 0 at the top.
struct FrameLayer {
  std::string name;  ///< "mw.radiance", "truth.range"
  std::string unit;
  std::vector<float> pixels;
};

struct Frame {
  std::string camera;
  std::string kind;  ///< "": the camera's channels; "spectral": its spectral image
  int number = 0;
  double time_s = 0.0;
  int width = 0, height = 0;
  std::vector<FrameLayer> layers;  ///< channels first, then truth
  std::vector<Attribute> attributes;
};

/// Turns integrals into quantities: value = scale x integral [x projected solid angle]. Adds truth layers and metadata (pose, optics,
/// bands, where each entity is in the picture, the error its plan expects).
Frame makeFrame(const Simulation& simulation, const Camera& camera, const CameraImage& image, const WorldState& state, int number);

/// The same in steps, for a frame drawn in several passes: no layers; the layers of a pass's outputs; the metadata, last.
Frame startFrame(const Camera& camera, const WorldState& state, int number);
void addOutputs(Frame& frame, const Camera& camera, const CameraImage& image);
void addMetadata(Frame& frame, const Simulation& simulation, const Camera& camera, const WorldState& state);
/// Aperture, film and exposure, as attributes.
void addOptics(Frame& frame, const Pinhole& pinhole, double exposure_s);
/// Unit of every layer, band of every output.
void addUnits(Frame& frame, const std::vector<ChannelOutput>& outputs);

/// "<camera>_00012" or "<camera>_00012_<kind>": the name of a frame's files without extension.
std::string frameFileStem(const Frame& frame);
std::string frameFileStem(const std::string& camera, int number, const std::string& kind);

/// One EXR with a layer per channel quantity and truth layer. `mayReplace`: as of writeFileAtomically. Errors: OutputError.
void writeFrame(const std::filesystem::path& folder, const Frame& frame, const MayReplace& mayReplace = {});
void writeFrameFile(const std::filesystem::path& file, const Frame& frame, const MayReplace& mayReplace = {});
/// Ends of the colour bar by layer name, in the layer's unit; layers without choose their own.
using PreviewRanges = std::map<std::string, std::pair<double, double>>;
/// One PNG per frame: channels side by side, each with colour bar and unit.
void writePreview(const std::filesystem::path& folder, const Frame& frame, const PreviewRanges& ranges = {}, const MayReplace& mayReplace = {});
void writePreviewFile(const std::filesystem::path& file, const Frame& frame, const PreviewRanges& ranges = {}, const MayReplace& mayReplace = {});

}  // namespace pitviper
