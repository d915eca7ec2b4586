#include "sim/camera/sensor_chain.hpp"

namespace pitviper {

SensorChain::SensorChain(const Camera& camera, const ShaderLibrary& library)
    : camera_(camera), pictures_{camera.outputs, cellsOf(camera), marginOf(camera), {}, {}} {
  const Camera drawn = drawnCamera(camera);
  width_ = drawn.pinhole.width;
  height_ = drawn.pinhole.height;
  for (size_t o = 0; o < camera.outputs.size(); ++o)
    for (auto* targets : {&pictures_.now, &pictures_.next}) targets->emplace_back(width_, height_, std::vector{PixelFormat::R32f}, false);
  for (const StageChoice& s : camera.stages) stages_.push_back(s.make(library));
}

std::vector<float> SensorChain::resolved(const std::vector<float>& cells, const std::vector<double>& weights, bool addsUp) const {
  const int n = pictures_.cells, margin = pictures_.margin_px;
  std::vector<float> pixels;
  pixels.reserve(static_cast<size_t>(camera_.pinhole.width) * static_cast<size_t>(camera_.pinhole.height));
  for (int row = 0; row < camera_.pinhole.height; ++row)
    for (int column = 0; column < camera_.pinhole.width; ++column) {
      double sum = 0.0, weight = 0.0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const size_t at = static_cast<size_t>((row + margin) * n + j) * static_cast<size_t>(width_) + static_cast<size_t>((column + margin) * n + i);
          sum += (addsUp ? 1.0 : weights[at]) * static_cast<double>(cells[at]);
          weight += weights[at];
        }
      pixels.push_back(static_cast<float>(addsUp ? sum : sum / weight));
    }
  return pixels;
}

std::vector<std::vector<float>> SensorChain::run(const std::vector<std::vector<float>>& drawn, const std::vector<double>& cellWeights, const SensorTick& tick) {
  for (size_t o = 0; o < drawn.size(); ++o) pictures_.now[o].colour(0).upload(drawn[o]);
  for (const auto& stage : stages_) stage->run(tick, pictures_);
  std::vector<std::vector<float>> pixels;
  std::vector<float> cells;
  for (size_t o = 0; o < drawn.size(); ++o) {
    pictures_.now[o].colour(0).download(cells);
    pixels.push_back(resolved(cells, cellWeights, camera_.outputs[o].perEtendue));
  }
  return pixels;
}

std::size_t SensorChain::middleCell(int column, int row) const {
  const int n = pictures_.cells, margin = pictures_.margin_px;
  return static_cast<size_t>((row + margin) * n + n / 2) * static_cast<size_t>(width_) + static_cast<size_t>((column + margin) * n + n / 2);
}

}  // namespace pitviper
