#include "sim/frame/frame_files.hpp"

#include <cstdio>

#include "sim/frame/file_owner.hpp"
#include "sim/image/png.hpp"
#include "sim/image/preview.hpp"

namespace pitviper {

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
  for (const auto& l : frame.layers) {
    if (l.name.rfind("truth.", 0) == 0) continue;
    PreviewOptions options;
    options.title = frame.camera + "  " + l.name + "  " + time;
    options.unit = l.unit;
    if (const auto range = ranges.find(l.name); range != ranges.end()) options.range = range->second;
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
