#include <algorithm>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/reader/sensor_reader.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/integrate.hpp"
#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

/// Where the frame goes: beside the image unless asked otherwise, never over the image.
fs::path outputOf(const Options& o, const fs::path& image, const fs::path& sensor) {
  if (!o.has("--out")) return image.parent_path() / (image.stem().string() + "_" + sensor.stem().string() + ".exr");
  const fs::path out = o.value("--out");
  const Location where{"--out " + out.string(), 0, 0, -1};
  if (out.extension() != ".exr") throw UserError(where, "not the name of an EXR file", "a name that ends in .exr", "write --out frame.exr");
  std::error_code ignored;
  if (fs::equivalent(out, image, ignored)) throw UserError(where, "this is the spectral image itself", "another file", "choose another name");
  return out;
}

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100.0 * fraction);
  return text;
}

}  // namespace

int integrateCommand(const Arguments& arguments) {
  const Options o("integrate", arguments, {{"--out"}, {"--preview", false}}, 2, 2);
  const fs::path file = o.words()[0], sensorFile = o.words()[1];
  fs::path out = outputOf(o, file, sensorFile);
  const SpectralImage image = readSpectralImage(file);
  const Sensor sensor = readSensor(sensorFile, image.pinhole, image.exposure_s, findLibraries());
  IntegratedFrame result = integrateSpectralImage(image, sensor.outputs, sensor.pinhole, sensor.exposure_s);
  Frame& frame = result.frame;
  frame.attributes.push_back({"pitviper.spectral_image", file.filename().string()});
  frame.attributes.push_back({"pitviper.sensor", sensor.name});
  frame.attributes.push_back({"pitviper.sensor_sha256", sensor.sha256});
  ensureWritableFolder(out.parent_path().empty() ? fs::path(".") : out.parent_path());
  writeExrFile(out, frame, {});
  std::printf("%-32s %-18s error of %zu bins alone: median, maximum over pixels\n", "layer", "unit", image.bins.size());
  for (size_t l = 0; l < frame.layers.size(); ++l)
    std::printf("%-32s %-18s %s, %s\n", frame.layers[l].name.c_str(), frame.layers[l].unit.c_str(), percent(result.binning[l].median).c_str(),
                percent(result.binning[l].maximum).c_str());
  std::printf("%s\n", out.string().c_str());
  if (o.has("--preview")) {
    out.replace_extension(".png");
    writePreviewFile(out, frame);
    std::printf("%s\n", out.string().c_str());
  }
  return 0;
}

}  // namespace pitviper
