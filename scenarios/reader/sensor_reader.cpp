// Spectral images: what a camera asks for, and the sensors that are applied to them.
#include "scenarios/reader/sensor_reader.hpp"

#include <cmath>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"

namespace pitviper {
namespace {

/// Half a gigabyte of floats a picture; two are held while one is written.
constexpr double kMostValues = 134217728.0;

/// Focal length and pitch as asked for, the pixels' angles as in the image.
void turnOptics(const Record& r, Pinhole& p) {
  double factor = 1.0;
  if (r.given("focal_length")) factor = r.number("focal_length") / p.focalLength_m;
  if (r.given("pixel_pitch")) {
    const double byPitch = r.number("pixel_pitch") / p.pitchX_m;
    if (r.given("focal_length") && std::abs(byPitch / factor - 1.0) > 1e-6)
      throw UserError(r.where("pixel_pitch"), "with this focal length a pixel would see " + briefNumber(byPitch / factor) + " times the angle of the image's",
                      "a pixel pitch of " + briefNumber(p.pitchX_m * factor * 1e6) + " um, or one of the two keys", "remove 'pixel_pitch' or 'focal_length'");
    factor = byPitch;
  }
  p.focalLength_m *= factor;
  p.pitchX_m *= factor;
  p.pitchY_m *= factor;
}

}  // namespace

SpectralBins Builder::readSpectralBins(const Record& r, const Pinhole& pinhole) {
  SpectralBins bins;
  bins.where = r.where();
  r.fill(bins);
  const int count = static_cast<int>(r.integer("bins"));
  const auto& band = r.value("band").items;
  const double low = onAxis(readNumber(band[0], "um", "band edge")), high = onAxis(readNumber(band[1], "um", "band edge"));
  if (!(low >= kShortestWavelength_um && low < high && high <= kLongestWavelength_um))
    throw UserError(r.where("band"), "the band of the spectral image is empty or outside the spectral axis", "rising edges within 0.1 to 1000 um",
                    "write 'band: [3 um, 5 um]'");
  if ((high / low - 1.0) / count < 1e-7)
    throw UserError(r.where("band"), "a band too narrow for " + std::to_string(count) + " bins", "bins wider than 1e-7 of their wavelength",
                    "widen the band or lower 'bins'");
  if (static_cast<double>(pinhole.width) * pinhole.height * count > kMostValues)
    throw UserError(
        r.where("bins"),
        "a spectral image of " + std::to_string(pinhole.width) + "x" + std::to_string(pinhole.height) + " pixels and " + std::to_string(count) + " bins",
        "at most 134 million values", "lower 'bins', or the film of this camera");
  const bool even = r.text("spacing") == "even";
  for (int i = 0; i < count; ++i) bins.edge_um.push_back(even ? low + (high - low) * i / count : low * std::pow(high / low, static_cast<double>(i) / count));
  bins.edge_um.push_back(high);
  // Any spectrum that ends inside the band is told of with all of the band, not bin by bin.
  ChannelOutput whole;
  whole.channel = "spectral_image";
  whole.where = bins.where;
  whole.kernel = Spectrum::band(low, high);
  planned({whole}, {bins.samples, Spacing::Gauss, false}, bins.where);
  return bins;
}

void Builder::readSensor(const Record& r, const Pinhole& image, double exposure_s, Sensor& sensor) {
  sensor.pinhole = image;
  turnOptics(r, sensor.pinhole);
  if (r.given("aperture")) sensor.pinhole.apertureDiameter_m = r.number("aperture");
  sensor.exposure_s = r.given("exposure") ? r.number("exposure") : exposure_s;
  Spectrum optics(1.0);
  if (r.given("optics")) optics = bounded(spectra_, r.value("optics"), "", "optics transmission", 0.0, 1.0, Outside::Zero);
  sensor.outputs = readChannels(r.value("channels"), &optics, &sensor.pinhole, sensor.exposure_s);
  // One by one: no pass has to hold them all. Finds kernels that are zero or that no spectrum covers.
  for (auto& output : sensor.outputs) {
    planned({output}, {}, output.where);
    tellTemperature(output);
  }
}

Sensor readSensor(const std::filesystem::path& file, const Pinhole& image, double exposure_s, const Libraries& libraries) {
  std::string text;
  const Value tree = loadYaml(file, {file.string(), 0, 0, -1}, &text);
  const Record r(tree, tables::sensor());
  Sensor sensor;
  sensor.name = r.given("name") ? r.text("name") : file.stem().string();
  sensor.sha256 = sha256(text);
  Simulation nothing;  // of a scene only what there is without one: darkness
  try {
    Builder(nothing, file.parent_path(), libraries).readSensor(r, image, exposure_s, sensor);
  } catch (const OutsideSpectrum& e) {
    throw UserError(tree.where, e.what(), "spectra that cover what they are multiplied with", "extend the table or narrow the band");
  }
  return sensor;
}

}  // namespace pitviper
