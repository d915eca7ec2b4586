#pragma once
// How layers of a frame are to be shown, and what is shown of one: values, scale, colours.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/view/display_scale.hpp"
#include "sim/frame/frame.hpp"
#include "sim/image/picture.hpp"
#include "sim/model/band_temperature.hpp"

namespace pitviper {

struct LayerLook {
  ScaleKind kind = ScaleKind::Linear;
  std::optional<std::pair<double, double>> ends = {};  ///< none: of each picture its own
  bool asTemperature = false;                          ///< of a radiance: the black body's that gives as much
  bool operator==(const LayerLook&) const = default;
};

struct FrameLook {
  std::map<std::string, LayerLook> layers;
  std::string map = "auto";  ///< a name of colour_map.hpp; auto: thermal, grey for what eyes see
  bool operator==(const FrameLook&) const = default;
};

/// A layer ready to be drawn.
struct LayerPicture {
  std::string title, unit;
  std::vector<float> values;
  DisplayScale scale;
  std::string map;            ///< of its colour bar
  std::vector<Rgb8> colours;  ///< of the pixels
};

/// `temperature`: of the layer's channel, which its look may ask for; null: it has none.
LayerPicture layerPicture(const Frame& frame, const FrameLayer& layer, const FrameLook& look, const BandTemperature* temperature);
/// Three layers as red, green and blue, each from its own low end to its high end; X, Y, Z as an eye sees them. Errors: std::invalid_argument for a layer that
/// is not there.
std::vector<Rgb8> compositePicture(const Frame& frame, const std::vector<std::string>& three, const FrameLook& look);

const FrameLayer* layerNamed(const Frame& frame, const std::string& name);

}  // namespace pitviper
