// Frames as TIFF, PNG and FITS: counts are whole numbers in them, and in PNG everything is.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/frame/file_formats.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/frame_json.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/image/fits.hpp"
#include "sim/image/png.hpp"
#include "sim/image/tiff.hpp"
#include "sim/image/whole_values.hpp"

namespace pitviper {
namespace {

/// Values spread over codes 1 to 65535; 0 where there is none.
LayerCode codeOf(const FrameLayer& layer, const std::string& file) {
  if (isCounts(layer)) return {layer.name, file, "uint16"};
  double low = INFINITY, high = -INFINITY;
  for (float v : layer.pixels)
    if (std::isfinite(v)) low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
  if (const auto ends = screenEnds(layer)) std::tie(low, high) = *ends;
  if (!(low <= high)) return {layer.name, file, "uint16", 0.0, 1.0, true};
  const double step = high > low ? (high - low) / 65534.0 : 1.0;
  return {layer.name, file, "uint16", low - step, step, true};
}

std::vector<std::uint16_t> codesOf(const FrameLayer& layer, const LayerCode& code) {
  if (!code.zeroIsNone) return wholeValues(layer.pixels);
  std::vector<float> values = layer.pixels;
  for (float& v : values) v = std::isfinite(v) ? static_cast<float>((static_cast<double>(v) - code.low) / code.step) : NAN;
  return wholeValues(values);
}

const double* numberOf(const Frame& frame, std::string_view name) {
  for (const Attribute& a : frame.attributes)
    if (a.name == name) return std::get_if<double>(&a.value);
  return nullptr;
}

}  // namespace

void writeTiffFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options) {
  std::vector<TiffPage> pages;
  std::vector<LayerCode> codes;
  for (const FrameLayer& l : frame.layers) {
    pages.push_back({l.name, l.name + " [" + l.unit + "]", isCounts(l), l.pixels});
    codes.push_back({l.name, file.filename().string(), isCounts(l) ? "uint16" : "float32"});
  }
  std::filesystem::path beside = file;
  writeTiff(file, frame.width, frame.height, pages, options.mayReplace);
  writeFileAtomically(beside.replace_extension(".json"), frameJson(frame, codes), options.mayReplace);
}

void writePngFiles(const std::filesystem::path& file, const Frame& frame, const FileOptions& options) {
  std::vector<LayerCode> codes;
  for (const FrameLayer& l : frame.layers) {
    const std::filesystem::path own = file.parent_path() / (file.stem().string() + "_" + l.name + ".png");
    codes.push_back(codeOf(l, own.filename().string()));
    writePngGrey(own, frame.width, frame.height, codesOf(l, codes.back()), pictureTexts(frame), options.mayReplace);
  }
  writeFileAtomically(file, frameJson(frame, codes), options.mayReplace);
}

void writeFitsFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options) {
  std::vector<FitsImage> images;
  for (const FrameLayer& l : frame.layers) images.push_back({l.name, l.unit, isCounts(l), l.pixels});
  std::vector<Attribute> keywords = {{"ORIGIN", "pitviper"}, {"INSTRUME", frame.camera}};
  const auto texts = pictureTexts(frame);
  if (const auto hash = texts.find(kScenarioHash); hash != texts.end()) keywords.push_back({kFitsHash, hash->second});
  if (const auto name = texts.find(kScenarioName); name != texts.end()) keywords.push_back({kFitsScenario, name->second});
  if (const double* exposure = numberOf(frame, "pitviper.exposure_s")) keywords.push_back({"EXPTIME", *exposure});
  for (const Attribute& a : frame.attributes)
    if (a.name == "pitviper.date_utc") {
      keywords.push_back({"DATE-OBS", a.value});
      keywords.push_back({"TIMESYS", "UTC"});
    }
  keywords.insert(keywords.end(), frame.attributes.begin(), frame.attributes.end());
  writeFits(file, frame.width, frame.height, images, keywords, options.mayReplace);
}

}  // namespace pitviper
