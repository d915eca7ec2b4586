#include "sim/camera/sensor_chain.hpp"

#include "sim/gl/timing.hpp"

namespace pitviper {

SensorChain::SensorChain(const Camera& camera, const ShaderLibrary& library)
    : camera_(camera),
      cells_(camera.outputs, drawnCamera(camera).pinhole.width, drawnCamera(camera).pinhole.height, cellsOf(camera), marginOf(camera)),
      pixels_(camera.outputs, camera.pinhole.width, camera.pinhole.height, 1, 0) {
  for (const StageChoice& s : camera.stages) (s.onPixels ? ofPixels_ : ofCells_).push_back({"sensor: " + s.name, s.make(library)});
}

std::vector<float> SensorChain::resolved(const std::vector<float>& cells, const std::vector<double>& weights, bool addsUp) const {
  const int n = cells_.cells, margin = cells_.margin_px;
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

std::vector<std::vector<float>> SensorChain::run(const std::vector<std::vector<float>>& drawn, const std::vector<double>& cellWeights, const SensorTick& tick,
                                                 std::vector<SensorPoint> points) {
  for (size_t o = 0; o < drawn.size(); ++o) cells_.values(o) = drawn[o];
  cells_.points = std::move(points);
  cells_.cellWeights = &cellWeights;
  run(ofCells_, tick, cells_);
  cells_.cellWeights = nullptr;
  pixels_.ownLight.clear();
  for (const ChannelOutput& o : camera_.outputs) pixels_.ownLight.push_back(ownLightOf(camera_, o, tick.axis_sr, tick.exposure_s));
  for (size_t o = 0; o < drawn.size(); ++o) pixels_.values(o) = resolved(cells_.values(o), cellWeights, camera_.outputs[o].perEtendue);
  run(ofPixels_, tick, pixels_);
  std::vector<std::vector<float>> pixels;
  for (size_t o = 0; o < drawn.size(); ++o) pixels.push_back(pixels_.values(o));
  return pixels;
}

void SensorChain::run(const std::vector<Named>& stages, const SensorTick& tick, SensorPictures& pictures) {
  for (const Named& s : stages) {
    const TimedPart part(s.part.c_str());
    s.stage->run(tick, pictures);
  }
}

const std::vector<double>& SensorChain::projectedSolidAngles(const Pinhole& pinhole) {
  if (!projected_ || projected_->first != pinhole.focalLength_m) projected_.emplace(pinhole.focalLength_m, pinhole.solidAngles().projected_sr);
  return projected_->second;
}

std::size_t SensorChain::middleCell(int column, int row) const {
  const int n = cells_.cells, margin = cells_.margin_px;
  return static_cast<size_t>((row + margin) * n + n / 2) * static_cast<size_t>(cells_.width) + static_cast<size_t>((column + margin) * n + n / 2);
}

}  // namespace pitviper
