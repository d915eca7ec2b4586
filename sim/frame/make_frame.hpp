#pragma once
// Makes frames of what the renderer leaves.
#include "sim/camera/camera_image.hpp"
#include "sim/camera/sensor_chain.hpp"
#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Turns integrals into quantities: value = scale x integral [x projected solid angle] [x exposure time], which then go through the sensor's stages
/// (`chain`; the image is then one of drawnCamera()). `targets`, `terms`: as TruthMeter has them. Adds truth layers and metadata (pose, optics, bands, where
/// each entity is in the picture, the error its plan expects).
Frame makeFrame(const Simulation& simulation, const Camera& camera, const CameraImage& image, const WorldState& state, int number,
                SensorChain* chain = nullptr, std::vector<TargetRow> targets = {}, std::vector<FrameLayer> terms = {});
/// The stages of a picture alone: pictures of the film's pixels, output by output. A chain whose stages remember takes frames before its first that way.
std::vector<std::vector<float>> sensed(const Simulation& simulation, const Camera& camera, const CameraImage& image, const WorldState& state, int number,
                                       SensorChain& chain);

/// Values of an output that is told as an apparent temperature, in its linear unit, become temperatures [K].
void toApparentTemperatures(std::vector<float>& values, const ChannelOutput& output, const std::vector<double>& projected_sr, double exposure_s);

/// The same in steps, for a frame drawn in several passes: no layers; the layers of a pass's outputs; the metadata, last.
Frame startFrame(const Camera& camera, const WorldState& state, int number);
void addOutputs(Frame& frame, const Camera& camera, const CameraImage& image);
void addMetadata(Frame& frame, const Simulation& simulation, const Camera& camera, const WorldState& state);
/// Aperture, film and exposure, as attributes.
void addOptics(Frame& frame, const Pinhole& pinhole, double exposure_s);
/// Unit of every layer, band of every output.
void addUnits(Frame& frame, const std::vector<ChannelOutput>& outputs);

}  // namespace pitviper
