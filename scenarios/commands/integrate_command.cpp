#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/sensor_reader.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/integrate.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

/// Where the frame goes: beside the image unless asked otherwise, never over the image.
fs::path outputOf(const fs::path& out, const fs::path& image, const fs::path& sensor) {
  if (out.empty()) return image.parent_path() / (image.stem().string() + "_" + sensor.stem().string() + ".exr");
  const Location where{"--out " + out.string(), 0, 0, -1};
  if (out.extension() != ".exr") throw UserError(where, "not the name of an EXR file", "a name that ends in .exr", "write --out frame.exr");
  std::error_code ignored;
  if (fs::equivalent(out, image, ignored)) throw UserError(where, "this is the spectral image itself", "another file", "choose another name");
  return out;
}

struct IntegrateWish {
  std::string out;
  bool preview = false;
};

int integrate(const IntegrateWish& w, const fs::path& file, const fs::path& sensorFile) {
  fs::path out = outputOf(w.out, file, sensorFile);
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
    std::printf("%-32s %-18s %.2g %%, %.2g %%\n", frame.layers[l].name.c_str(), frame.layers[l].unit.c_str(), 100.0 * result.binning[l].median,
                100.0 * result.binning[l].maximum);
  std::printf("%s\n", out.string().c_str());
  if (w.preview) {
    out.replace_extension(".png");
    writePreviewFile(out, frame);
    std::printf("%s\n", out.string().c_str());
  }
  return 0;
}

}  // namespace

CommandLine integrateCommand() {
  const auto w = std::make_shared<IntegrateWish>();
  return {{"integrate", "FILE_spectral.exr SENSOR.yaml", "apply another sensor to a spectral image"},
          "Integrates a spectral image (a camera's 'spectral_image:') over the channels of a sensor file, such as scenarios/sensors/mw_insb.yaml: the same "
          "keys 'channels', 'optics', 'exposure' and 'aperture' as of a camera; what it leaves out is as of the camera. Writes an EXR with a layer "
          "<channel>.<quantity> per output. The sensor meets each bin's mean radiance: exact where its response is flat over the bin; how far off the others "
          "are, to first order, is printed per layer and kept as attribute binning_error.<layer> (median and maximum over pixels).",
          {{"--out", "FILE.exr", "what to write; otherwise <image>_<sensor>.exr beside the image", into(w->out)},
           {"--preview", "", "also a PNG: every channel with colour bar and unit", into(w->preview)}},
          [w](const Arguments& words) { return integrate(*w, words[0], words[1]); },
          "The bins must cover every channel: one that reaches beyond them is refused."};
}

}  // namespace pitviper
