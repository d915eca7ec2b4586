#include "sim/camera/sensor_chain.hpp"

#include <algorithm>

#include "sim/gl/timing.hpp"

namespace pitviper {

StageLine::StageLine(const Camera& camera, std::vector<ChannelOutput> outputs, const std::vector<StageChoice>& stages, const ShaderLibrary& library)
    : camera_(camera),
      outputs_(std::move(outputs)),
      cells_(outputs_, drawnCamera(camera).pinhole.width, drawnCamera(camera).pinhole.height, cellsOf(camera), marginOf(camera)),
      pixels_(outputs_, camera.pinhole.width, camera.pinhole.height, 1, 0) {
  for (const StageChoice& s : stages) (s.onPixels ? ofPixels_ : ofCells_).push_back({"sensor: " + s.name, s.make(library)});
}

std::vector<float> StageLine::resolved(std::vector<float> cells, const std::vector<double>& weights, bool addsUp) const {
  const int n = cells_.cells, margin = cells_.margin_px;
  if (n == 1 && margin == 0) return cells;  // each is its own mean
  std::vector<float> pixels;
  pixels.reserve(static_cast<size_t>(camera_.pinhole.width) * static_cast<size_t>(camera_.pinhole.height));
  for (int row = 0; row < camera_.pinhole.height; ++row)
    for (int column = 0; column < camera_.pinhole.width; ++column) {
      double sum = 0.0, weight = 0.0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const size_t at = static_cast<size_t>((row + margin) * n + j) * static_cast<size_t>(cells_.width) + static_cast<size_t>((column + margin) * n + i);
          sum += (addsUp ? 1.0 : weights[at]) * static_cast<double>(cells[at]);
          weight += weights[at];
        }
      pixels.push_back(static_cast<float>(addsUp ? sum : sum / weight));
    }
  return pixels;
}

std::vector<std::vector<float>> StageLine::run(std::vector<std::vector<float>> drawn, const std::vector<double>& cellWeights, const SensorTick& tick,
                                               std::vector<SensorPoint> points) {
  calibrate(cellWeights, tick);
  for (size_t o = 0; o < drawn.size(); ++o) cells_.values(o) = std::move(drawn[o]);
  cells_.points = std::move(points);
  cells_.cellWeights = &cellWeights;
  run(ofCells_, tick, cells_);
  cells_.cellWeights = nullptr;
  for (size_t o = 0; o < drawn.size(); ++o) pixels_.values(o) = resolved(std::move(cells_.values(o)), cellWeights, outputs_[o].perEtendue);
  run(ofPixels_, tick, pixels_);
  std::vector<std::vector<float>> pixels;
  for (size_t o = 0; o < drawn.size(); ++o) pixels.push_back(std::move(pixels_.values(o)));
  return pixels;
}

void StageLine::run(const std::vector<Named>& stages, const SensorTick& tick, SensorPictures& pictures) {
  for (const Named& s : stages) {
    const TimedPart part(s.part.c_str());
    s.stage->run(tick, pictures);
  }
}

void StageLine::calibrate(const std::vector<double>& cellWeights, const SensorTick& tick) {
  if (tick.focalLength_m == calibratedFocal_m_ && tick.exposure_s == calibratedExposure_s_) return;
  calibratedFocal_m_ = tick.focalLength_m, calibratedExposure_s_ = tick.exposure_s;
  const std::size_t count = outputs_.size();
  seen_.assign(count, {});
  pixels_.ownLight.assign(count, {});
  const bool asked = std::any_of(outputs_.begin(), outputs_.end(), [](const ChannelOutput& o) { return o.asTemperature && o.perEtendue; });
  if (!asked) return;
  const auto unitOf = [&](std::size_t o) { return outputs_[o].scale * (outputs_[o].perExposure ? tick.exposure_s : 1.0); };
  const auto through = [&](const std::vector<double>& radiance) {
    for (std::size_t o = 0; o < count; ++o) {
      const ChannelOutput& output = outputs_[o];
      std::vector<float>& cells = cells_.values(o);
      cells.clear();
      for (double sr : cellWeights) cells.push_back(static_cast<float>(radiance[o] * unitOf(o) * (output.perEtendue ? sr : 1.0)));
    }
    cells_.points.clear();
    cells_.cellWeights = &cellWeights;
    run(ofCells_, tick, cells_);
    cells_.cellWeights = nullptr;
    std::vector<std::vector<float>> pixels;
    for (std::size_t o = 0; o < count; ++o) pixels.push_back(resolved(cells_.values(o), cellWeights, outputs_[o].perEtendue));
    return pixels;
  };
  // Nothing at all; then an even field, ten times as bright as the sensor's own light so that their difference has its digits.
  pixels_.ownLight = through(std::vector<double>(count, 0.0));
  std::vector<double> radiance;
  for (std::size_t o = 0; o < count; ++o) {
    const auto middle = pixels_.ownLight[o].size() / 2;
    const double own = static_cast<double>(pixels_.ownLight[o][middle]);
    radiance.push_back(own > 0.0 ? 10.0 * own / (unitOf(o) * tick.axis_sr) : 1.0 / unitOf(o));
  }
  const auto lit = through(radiance);
  for (std::size_t o = 0; o < count; ++o)
    for (std::size_t p = 0; p < lit[o].size(); ++p)
      seen_[o].push_back((static_cast<double>(lit[o][p]) - static_cast<double>(pixels_.ownLight[o][p])) / (unitOf(o) * radiance[o]));
}

SensorChain::SensorChain(const Camera& camera, const ShaderLibrary& library)
    : width_(drawnCamera(camera).pinhole.width), cells_(cellsOf(camera)), margin_px_(marginOf(camera)) {
  // Channels that have nothing of their own go together.
  std::vector<std::string> names;
  std::vector<std::vector<ChannelOutput>> outputs;
  for (const ChannelOutput& o : camera.outputs) {
    const std::string name = camera.ownChannel(o.channel) ? o.channel : "";
    const auto line = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (line == names.size()) names.push_back(name), outputs.emplace_back();
    places_.push_back({line, outputs[line].size()});
    outputs[line].push_back(o);
  }
  for (std::size_t k = 0; k < names.size(); ++k)
    lines_.push_back(std::make_unique<StageLine>(camera, outputs[k], names[k].empty() ? camera.stages : camera.stagesOf(names[k]), library));
}

std::vector<std::vector<float>> SensorChain::run(std::vector<std::vector<float>> drawn, const std::vector<double>& cellWeights, const SensorTick& tick,
                                                 std::vector<SensorPoint> points) {
  std::vector<std::vector<std::vector<float>>> ofLine(lines_.size());
  std::vector<std::vector<SensorPoint>> pointsOf(lines_.size());
  for (std::size_t o = 0; o < drawn.size(); ++o) ofLine[places_[o].line].push_back(std::move(drawn[o]));
  for (SensorPoint& p : points) {
    const Place& place = places_[p.output];
    p.output = place.output;
    pointsOf[place.line].push_back(p);
  }
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    SensorTick own = tick;
    own.exposure_s = tick.exposures_s.of(lines_[k]->outputs().front().channel);
    own.gain = tick.gains.of(lines_[k]->outputs().front().channel);
    ofLine[k] = lines_[k]->run(std::move(ofLine[k]), cellWeights, own, std::move(pointsOf[k]));
  }
  std::vector<std::vector<float>> pixels;
  for (const Place& p : places_) pixels.push_back(std::move(ofLine[p.line][p.output]));
  return pixels;
}

CountMarks SensorChain::marks() const {
  CountMarks all;
  for (const auto& line : lines_) all.insert(line->marks().begin(), line->marks().end());
  return all;
}

std::size_t SensorChain::middleCell(int column, int row) const {
  return static_cast<size_t>((row + margin_px_) * cells_ + cells_ / 2) * static_cast<size_t>(width_) +
         static_cast<size_t>((column + margin_px_) * cells_ + cells_ / 2);
}

}  // namespace pitviper
