#include "scenarios/view/layer_look.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/frame/frame_picture.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/image/srgb.hpp"

namespace pitviper {
namespace {

constexpr Rgb8 kNoNumber{255, 0, 255};
/// Bands that begin below are grey: eyes know them so.
constexpr double kEyesEnd_um = 0.9;

LayerLook lookOf(const FrameLook& look, const std::string& layer) {
  const auto found = look.layers.find(layer);
  return found == look.layers.end() ? LayerLook{} : found->second;
}

std::string mapOf(const Frame& frame, const FrameLayer& layer, const FrameLook& look) {
  if (look.map != "auto") return look.map;
  if (screenEnds(layer)) return "white_hot";
  for (const Attribute& a : frame.attributes)
    if (a.name == "band_um." + layer.name) {
      const auto* text = std::get_if<std::string>(&a.value);
      return text && std::atof(text->c_str()) < kEyesEnd_um ? "white_hot" : "thermal";
    }
  return "thermal";
}

std::vector<double> shares(const Frame& frame, const std::string& name, const FrameLook& look) {
  const FrameLayer* layer = layerNamed(frame, name);
  if (!layer) throw std::invalid_argument("no layer " + name);
  const LayerPicture picture = layerPicture(frame, *layer, look, nullptr);
  std::vector<double> all;
  for (float v : picture.values) all.push_back(picture.scale.position(v));
  return all;
}

}  // namespace

const FrameLayer* layerNamed(const Frame& frame, const std::string& name) {
  for (const FrameLayer& l : frame.layers)
    if (l.name == name) return &l;
  return nullptr;
}

LayerPicture layerPicture(const Frame& frame, const FrameLayer& layer, const FrameLook& look, const BandTemperature* temperature) {
  LayerLook own = lookOf(look, layer.name);
  LayerPicture picture{layer.name, layer.unit, layer.pixels, {}, mapOf(frame, layer, look), {}};
  if (own.asTemperature && temperature) {
    for (float& v : picture.values) v = std::isfinite(v) ? static_cast<float>((*temperature)(v)) : v;
    picture.unit = "K, apparent";
  }
  const auto ends = own.ends ? *own.ends : screenEnds(layer) ? *screenEnds(layer) : DisplayScale::endsOf(picture.values);
  picture.scale = DisplayScale(own.kind, ends.first, ends.second, picture.values);
  const ColourMap& map = colourMap(picture.map);
  constexpr int kSteps = 1024;
  std::vector<Rgb8> steps;
  for (int k = 0; k <= kSteps; ++k) steps.push_back(map(static_cast<float>(k) / kSteps));
  picture.colours.reserve(picture.values.size());
  for (float v : picture.values)
    picture.colours.push_back(std::isfinite(v) ? steps[static_cast<std::size_t>(picture.scale.position(v) * kSteps + 0.5)] : kNoNumber);
  return picture;
}

std::vector<Rgb8> compositePicture(const Frame& frame, const std::vector<std::string>& three, const FrameLook& look) {
  if (three.size() != 3) throw std::invalid_argument("a composite of other than three layers");
  if (three[0] == "X.tristimulus") {
    const FrameLayer *x = layerNamed(frame, three[0]), *y = layerNamed(frame, three[1]), *z = layerNamed(frame, three[2]);
    if (!x || !y || !z) throw std::invalid_argument("no tristimulus values");
    return srgbPixels(x->pixels, y->pixels, z->pixels, DisplayScale::endsOf(strongestPrimary(x->pixels, y->pixels, z->pixels)).second);
  }
  const std::vector<double> r = shares(frame, three[0], look), g = shares(frame, three[1], look), b = shares(frame, three[2], look);
  const auto code = [](double v) { return static_cast<std::uint8_t>(std::lround(255.0 * v)); };
  std::vector<Rgb8> all;
  for (std::size_t p = 0; p < r.size(); ++p) all.push_back({code(r[p]), code(g[p]), code(b[p])});
  return all;
}

}  // namespace pitviper
