#include "sim/frame/pixel_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/frame/spectral_image.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Temperatures at both ends of BandTemperature.
constexpr double kColdest_K = 20.0, kHottest_K = 20000.0;
/// More bins than these have nothing to show: about 1/cm each in the infrared.
constexpr int kMostBins = 4096;

/// The same camera for the eyes of the reference alone.
Camera referenceOf(const Camera& camera) {
  Camera reference = camera;
  reference.spectral = {};
  reference.spectral.reference = true;
  reference.truth = {};
  reference.spectralImage.reset();
  return reference;
}

/// Before a detector, and before temperatures.
std::string linearUnit(const ChannelOutput& o) { return o.detected ? "electron" : o.asTemperature ? "W/(m2 sr)" : o.unit; }

bool isDarkThroughout(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
}

/// What parts leave of a whole.
template <class Parts>
std::vector<double> restOf(const std::vector<double>& all, const Parts& parts) {
  std::vector<double> rest = all;
  for (const auto& part : parts)
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= part.values[k];
  return rest;
}

}  // namespace

std::optional<double> apparentTemperature_K(const PixelParts::Column& column, double value) {
  if (!(value > 0.0)) return {};
  const double temperature_K = (*column.temperature)(value / column.perIntegral);
  if (!(temperature_K >= kColdest_K && temperature_K < kHottest_K)) return {};
  return temperature_K;
}

PixelPartsMeter::Pass::Pass(const Simulation& simulation, Camera of, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : camera(std::move(of)), renderer(simulation, camera, cameraPlan(simulation, camera), library, std::move(scene)) {}

PixelPartsMeter::PixelPartsMeter(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation),
      library_(library),
      scene_(std::move(scene)),
      camera_(referenceOf(camera)),
      renderer_(simulation, camera_, cameraPlan(simulation, camera_), library, scene_) {
  for (const ChannelOutput& o : camera_.outputs)
    temperatures_.push_back(o.temperature ? o.temperature : std::make_shared<const BandTemperature>(o.kernel, o.bandLow_um, o.bandHigh_um));
}

std::size_t PixelPartsMeter::indexOf(int column, int row) const {
  const int width = camera_.pinhole.width, height = camera_.pinhole.height;
  if (column < 0 || row < 0 || column >= width || row >= height)
    throw UserError(camera_.where, print("pixel %d,%d is not of camera '%s'", column, row, camera_.name.c_str()),
                    print("a column below %d and a row below %d", width, height), "choose one of those");
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
}

std::string PixelPartsMeter::nameOf(const Part& part) const {
  std::string name = pitviper::nameOf(part.kind);
  if (part.light >= 0)
    name = (part.kind == TermKind::LampsInView ? "lamp in view: " : "reflected light of ") + simulation_.lights[static_cast<std::size_t>(part.light)].name;
  if (part.entity >= 0) name += ": " + simulation_.entities[static_cast<std::size_t>(part.entity)].name;
  return name;
}

PixelParts PixelPartsMeter::at(const WorldState& state, int column, int row) {
  const std::size_t pixel = indexOf(column, row);
  PixelParts parts;
  const auto draw = [&](const std::optional<Part>& part) {
    renderer_.setOnly(part);
    const CameraImage image = renderer_.render(state);
    std::vector<double> values;
    parts.columns.clear();
    for (std::size_t o = 0; o < camera_.outputs.size(); ++o) {
      const ChannelOutput& output = camera_.outputs[o];
      const double etendue = output.perEtendue ? image.solidAngles->projected_sr[pixel] : 1.0,
                   exposure = output.perExposure ? image.exposures_s.of(output.channel) : 1.0, perIntegral = output.scale * etendue * exposure;
      parts.columns.push_back({output.layer(), linearUnit(output), perIntegral, temperatures_[o]});
      values.push_back(perIntegral * image.slots[static_cast<std::size_t>(image.slotOfOutput[o])][pixel]);
    }
    return values;
  };
  renderer_.setWanted({static_cast<int>(pixel)});
  renderer_.watchParts();
  parts.all = draw({});
  for (const Part& part : renderer_.parts()) {
    std::vector<double> values = draw(part);
    if (!isDarkThroughout(values)) parts.rows.push_back({nameOf(part), part, std::move(values)});
  }
  parts.rest = restOf(parts.all, parts.rows);
  return parts;
}

void PixelPartsMeter::makePasses(double low_um, double high_um, int bins) {
  if (!(low_um >= kShortestWavelength_um && low_um < high_um && high_um <= kLongestWavelength_um && bins >= 1 && bins <= kMostBins))
    throw UserError(camera_.where, print("a spectrum from %g to %g um in %d bins", low_um, high_um, bins),
                    print("a rising range within %g to %g um, and 1 to %d bins", kShortestWavelength_um, kLongestWavelength_um, kMostBins),
                    "choose such a range");
  SpectralBins asked;
  for (int b = 0; b <= bins; ++b) asked.edge_um.push_back(b == bins ? high_um : low_um + (high_um - low_um) * b / bins);
  asked.where = camera_.where;
  if (asked.edge_um == bins_.edge_um) return;
  passes_.clear();
  bins_ = {};
  for (int first = 0; first < bins; first += kMostSlots) {
    Camera pass = camera_;
    // A plan is of the channels.
    pass.plan.clear();
    pass.outputs.clear();
    for (int b = first; b < std::min(first + kMostSlots, bins); ++b) pass.outputs.push_back(binOutput(asked, b));
    passes_.push_back(std::make_unique<Pass>(simulation_, std::move(pass), library_, scene_));
  }
  bins_ = std::move(asked);
}

PixelSpectrum PixelPartsMeter::spectrum(const WorldState& state, int column, int row, double low_um, double high_um, int bins) {
  const std::size_t pixel = indexOf(column, row), count = static_cast<std::size_t>(std::max(bins, 0));
  makePasses(low_um, high_um, bins);
  PixelSpectrum spectrum;
  spectrum.edge_um = bins_.edge_um;
  for (std::size_t b = 0; b < count; ++b) spectrum.wavelength_um.push_back(0.5 * (bins_.edge_um[b] + bins_.edge_um[b + 1]));
  // The channels' picture says which bright parts have views of their own: a spectrum is of the same lines.
  renderer_.setOnly({});
  renderer_.setWanted({static_cast<int>(pixel)});
  const std::vector<Ball> bright = renderer_.render(state).parts;
  spectrum.all.assign(count, 0.0);
  std::map<Part, std::vector<double>> curves;
  std::size_t first = 0;
  for (const auto& pass : passes_) {
    const auto add = [&](const std::optional<Part>& part, std::vector<double>& to) {
      pass->renderer.setOnly(part);
      const CameraImage image = pass->renderer.render(state);
      for (std::size_t o = 0; o < pass->camera.outputs.size(); ++o) to[first + o] += image.slots[static_cast<std::size_t>(image.slotOfOutput[o])][pixel];
    };
    pass->renderer.setParts(bright);
    pass->renderer.setWanted({static_cast<int>(pixel)});
    pass->renderer.watchParts();
    add({}, spectrum.all);
    for (const Part& part : pass->renderer.parts()) {
      std::vector<double>& curve = curves[{part.kind, -1, part.light}];
      curve.resize(count, 0.0);
      add(part, curve);
    }
    first += pass->camera.outputs.size();
  }
  for (auto& [part, values] : curves)
    if (!isDarkThroughout(values)) spectrum.parts.push_back({nameOf(part), part, std::move(values)});
  spectrum.rest = restOf(spectrum.all, spectrum.parts);
  return spectrum;
}

}  // namespace pitviper
