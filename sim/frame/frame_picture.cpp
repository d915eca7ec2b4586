#include "sim/frame/frame_picture.hpp"

#include <algorithm>
#include <cmath>

#include "sim/frame/file_owner.hpp"
#include "sim/image/png.hpp"
#include "sim/image/srgb.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

const FrameLayer* layerNamed(const Frame& frame, std::string_view name) {
  for (const FrameLayer& l : frame.layers)
    if (l.name == name) return &l;
  return nullptr;
}

/// X, Y, Z where a frame has all three: an eye sees one picture.
struct Eye {
  const FrameLayer *x, *y, *z;
  explicit Eye(const Frame& frame)
      : x(layerNamed(frame, "X.tristimulus")), y(layerNamed(frame, "Y.tristimulus")), z(layerNamed(frame, "Z.tristimulus")) {
    if (!x || !y || !z) x = y = z = nullptr;
  }
};

std::string paletteOf(const Frame& frame, const FrameLayer& layer, const PictureStyle& style) {
  constexpr double kEyesEnd_um = 0.9;
  if (style.palette != "auto") return style.palette;
  if (screenEnds(layer)) return "white_hot";
  for (const auto& a : frame.attributes)
    if (a.name == "band_um." + layer.name) return std::stod(std::get<std::string>(a.value)) < kEyesEnd_um ? "white_hot" : "thermal";
  return "thermal";
}

Rgb8Image pictureOf(const Frame& frame, const FrameLayer& layer, const PictureStyle& style, const LayerScales& scales) {
  const Eye eye(frame);
  PreviewOptions options;
  const std::string time = print("t = %.3f s", frame.time_s);
  options.title = frame.camera + "  " + layer.name + "  " + time;
  if (std::any_of(layer.pixels.begin(), layer.pixels.end(), [](float v) { return !std::isfinite(v); })) options.title += "  magenta: none";
  options.unit = layer.unit;
  options.colourMap = paletteOf(frame, layer, style);
  if (const auto range = style.ranges.find(layer.name); range != style.ranges.end()) options.range = range->second;
  else if (const auto ends = screenEnds(layer)) options.range = ends;
  else if (style.range) options.range = style.range;
  else if (const auto scale = scales.find(layer.name); scale != scales.end()) options.scale = scale->second;
  if (&layer == eye.y) {
    // The brightest that a screen shows of its strongest primary, so that no lamp's colour is cut.
    const double white = options.range   ? options.range->second
                         : options.scale ? options.scale->high()
                                         : PictureScale::of(scaledValues(frame, layer)).high();
    options.title = frame.camera + "  sRGB, not adapted  " + time;
    options.scale.reset();
    options.range = {0.0, white};
    options.colourMap = "white_hot";
    options.colours = srgbPixels(eye.x->pixels, layer.pixels, eye.z->pixels, white);
  }
  return (style.plain ? makePlainPreview : makePreview)(frame.width, frame.height, layer.pixels, options);
}

}  // namespace

std::vector<const FrameLayer*> shownLayers(const Frame& frame, const PictureStyle& style) {
  const Eye eye(frame);
  std::vector<const FrameLayer*> shown;
  for (const FrameLayer& l : frame.layers)
    if ((style.truth || l.name.rfind("truth.", 0) != 0) && !(eye.y && (&l == eye.x || &l == eye.z))) shown.push_back(&l);
  return shown;
}

std::optional<std::pair<double, double>> screenEnds(const FrameLayer& layer) {
  if (layer.unit != "code") return std::nullopt;
  return std::pair{0.0, 255.0};
}

std::vector<float> scaledValues(const Frame& frame, const FrameLayer& layer) {
  const Eye eye(frame);
  return &layer == eye.y ? strongestPrimary(eye.x->pixels, layer.pixels, eye.z->pixels) : layer.pixels;
}

Rgb8Image pictureOf(const Frame& frame, const PictureStyle& style, const LayerScales& scales, bool firstAlone) {
  std::vector<Rgb8Image> pictures;
  for (const FrameLayer* l : shownLayers(frame, style)) {
    pictures.push_back(pictureOf(frame, *l, style, scales));
    if (firstAlone) break;
  }
  return placeSideBySide(pictures);
}

std::map<std::string, std::string> pictureTexts(const Frame& frame) {
  std::map<std::string, std::string> texts;
  for (const auto& a : frame.attributes)
    if (const auto* text = std::get_if<std::string>(&a.value); text && (a.name == kScenarioName || a.name == kScenarioHash)) texts[a.name] = *text;
  return texts;
}

void writePreviewFile(const std::filesystem::path& file, const Frame& frame, const PictureStyle& style, const MayReplace& mayReplace) {
  writePng(file, pictureOf(frame, style), pictureTexts(frame), mayReplace);
}

}  // namespace pitviper
