#include "sim/render/geometry/raster_tracer.hpp"

#include <algorithm>

#include "sim/render/geometry/transparent_draws.hpp"
#include "sim/render/geometry/view_data.hpp"

namespace pitviper {

RasterTracer::RasterTracer(const Simulation& simulation, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation), scene_(std::move(scene)), items_(drawItems(simulation)), solids_(simulation, items_, *scene_, library) {
  std::vector<HitLists::Kind> kinds;
  for (const DrawItem& item : items_)
    if (item.kind == DrawKind::Layer) kinds.push_back(HitLists::Kind::Pane);
    else if (isMeshed(item)) kinds.push_back(HitLists::Kind::Border);
  if (kinds.empty()) return;
  ShaderSlots slots;  // where a line ends at the ground is the equation's business
  slots.files["ground"] = "sim/render/geometry/glsl/ground_none.glsl";
  slots.files["ground_end"] = "sim/render/geometry/glsl/ground_endless.glsl";
  hits_ = std::make_unique<HitLists>(library, slots, kinds);
}

bool RasterTracer::isMeshed(const DrawItem& item) const {
  return item.kind == DrawKind::Medium && simulation_.entities[static_cast<size_t>(item.entity)].form.kind == BodyForm::Kind::Mesh;
}

SeenLines RasterTracer::see(const View& v, const WorldState& state, const std::vector<char>& drawn) {
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
  view_.bindTexture(kViewUnit, 4);
  solids_.draw(*target, v, state, drawn);
  readback_.start(*target, 0, target);
  const auto identity = readback_.wait().identity;
  SeenLines seen;
  seen.solid.resize(identity.size() / 2);
  for (size_t p = 0; p < seen.solid.size(); ++p) seen.solid[p] = triangleOf(identity[2 * p], identity[2 * p + 1]);
  if (hits_) addPanes(*target, v, state, drawn, seen);
  return seen;
}

SeenTriangle RasterTracer::triangleOf(std::uint32_t draw, std::uint32_t triangle) const {
  const int entity = items_[draw].entity;
  return entity < 0 ? SeenTriangle{} : SeenTriangle{entity, triangle - scene_->firstTriangle(entity)};
}

void RasterTracer::addPanes(const RenderTarget& visibility, const View& view, const WorldState& state, const std::vector<char>& drawn, SeenLines& seen) {
  const std::vector<std::size_t> inView = transparentIn(items_, simulation_, view, state, drawn);
  hits_->find(visibility, [&] {
    for (std::size_t d : inView)
      if (items_[d].kind == DrawKind::Layer) drawPane(*hits_, *scene_, simulation_, items_[d], d);
      else if (isMeshed(items_[d])) drawMedium(*hits_, *scene_, simulation_, items_[d], d);
  });
  std::vector<std::vector<SeenTriangle>> panes(seen.solid.size());
  hits_->eachHit([&](int x, int y, const glm::uvec4& hit) {
    panes[static_cast<size_t>(y) * static_cast<size_t>(view.width) + static_cast<size_t>(x)].push_back(triangleOf(hit.x & 0x3fffffffu, hit.w));
  });
  for (const auto& line : panes) {
    seen.firstPane.push_back(static_cast<std::uint32_t>(seen.panes.size()));
    seen.panes.insert(seen.panes.end(), line.begin(), line.end());
  }
  seen.firstPane.push_back(static_cast<std::uint32_t>(seen.panes.size()));
}

}  // namespace pitviper
