#include "sim/frame/frame_files.hpp"

#include <cstdio>

#include "sim/frame/file_owner.hpp"
#include "sim/image/png.hpp"
#include "sim/image/preview.hpp"
#include "sim/image/srgb.hpp"

namespace pitviper {
namespace {

const FrameLayer* layerNamed(const Frame& frame, const char* name) {
  for (const FrameLayer& l : frame.layers)
    if (l.name == name) return &l;
  return nullptr;
}

}  // namespace

void writeFrame(const std::filesystem::path& folder, const Frame& frame, const MayReplace& mayReplace, ExrCompression compression) {
  writeFrameFile(folder / (frameFileStem(frame) + ".exr"), frame, mayReplace, compression);
}

void writeFrameFile(const std::filesystem::path& file, const Frame& frame, const MayReplace& mayReplace, ExrCompression compression) {
  ExrImage image;
  image.width = frame.width;
  image.height = frame.height;
  for (const auto& l : frame.layers) image.layers.push_back({l.name, l.pixels});
  image.attributes = frame.attributes;
  writeExr(file, image, mayReplace, compression);
}

void writePreview(const std::filesystem::path& folder, const Frame& frame, const PreviewRanges& ranges, const MayReplace& mayReplace) {
  writePreviewFile(folder / (frameFileStem(frame) + ".png"), frame, ranges, mayReplace);
}

void writePreviewFile(const std::filesystem::path& file, const Frame& frame, const PreviewRanges& ranges, const MayReplace& mayReplace) {
  std::vector<Rgb8Image> pictures;
  char time[32];
  std::snprintf(time, sizeof time, "t = %.3f s", frame.time_s);
  const FrameLayer* eye[3] = {layerNamed(frame, "X.tristimulus"), layerNamed(frame, "Y.tristimulus"), layerNamed(frame, "Z.tristimulus")};
  const bool seen = eye[0] && eye[1] && eye[2];
  for (const auto& l : frame.layers) {
    // An eye sees one picture.
    if (l.name.rfind("truth.", 0) == 0 || (seen && (&l == eye[0] || &l == eye[2]))) continue;
    PreviewOptions options;
    options.title = frame.camera + "  " + l.name + "  " + time;
    options.unit = l.unit;
    if (const auto range = ranges.find(l.name); range != ranges.end()) options.range = range->second;
    if (seen && &l == eye[1]) {
      // The brightest that a screen shows of its strongest primary, so that no lamp's colour is cut.
      const double white = options.range ? options.range->second : automaticRange(strongestPrimary(eye[0]->pixels, l.pixels, eye[2]->pixels)).second;
      options.title = frame.camera + "  sRGB, not adapted  " + time;
      options.range = {0.0, white};
      options.colourMap = "grey";
      options.colours = srgbPixels(eye[0]->pixels, l.pixels, eye[2]->pixels, white);
      pictures.push_back(makePreview(frame.width, frame.height, l.pixels, options));
      continue;
    }
    const std::string band = [&] {
      for (const auto& a : frame.attributes)
        if (a.name == "band_um." + l.name) return std::get<std::string>(a.value);
      return std::string();
    }();
    options.colourMap = !band.empty() && std::stod(band) < 0.9 ? "grey" : "thermal";
    pictures.push_back(makePreview(frame.width, frame.height, l.pixels, options));
  }
  std::map<std::string, std::string> texts;
  for (const auto& a : frame.attributes)
    if (const auto* text = std::get_if<std::string>(&a.value); text && (a.name == kScenarioName || a.name == kScenarioHash)) texts[a.name] = *text;
  writePng(file, placeSideBySide(pictures), texts, mayReplace);
}

}  // namespace pitviper
