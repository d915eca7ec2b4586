#include "sim/render/raster_tracer.hpp"

#include "sim/render/view_data.hpp"

namespace pitviper {

RasterTracer::RasterTracer(const Simulation& simulation, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation), scene_(std::move(scene)), items_(drawItems(simulation)), solids_(simulation, items_, *scene_, library) {}

std::vector<SeenTriangle> RasterTracer::see(const View& v, const WorldState& state, const std::vector<char>& drawn) {
  RenderTarget* target = nullptr;
  for (RenderTarget& t : targets_)
    if (t.width() == v.width && t.height() == v.height) target = &t;
  if (!target) target = &targets_.emplace_back(v.width, v.height, std::vector<PixelFormat>{PixelFormat::Rg32ui}, true);
  std::vector<GpuDraw> draws;
  for (const DrawItem& item : items_) draws.push_back(drawData(simulation_, item, v, state));
  draws_.upload(draws);
  const GpuView view = viewData(simulation_, v, 0.0);
  view_.upload(&view, sizeof view);
  scene_->bind();
  draws_.bindTexture(8, 4, true);
  view_.bindUniform(0);
  solids_.draw(*target, v, state, drawn);
  readback_.start(*target, 0, target);
  const auto identity = readback_.wait().identity;
  std::vector<SeenTriangle> seen(identity.size() / 2);
  for (size_t p = 0; p < seen.size(); ++p)
    if (const DrawItem& item = items_[identity[2 * p]]; item.entity >= 0) seen[p] = {item.entity, identity[2 * p + 1] - scene_->firstTriangle(item.entity)};
  return seen;
}

}  // namespace pitviper
