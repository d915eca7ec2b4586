#include "sim/render/reference/reference_drawer.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <mutex>
#include <thread>

#include "sim/render/reference/pixel_truth.hpp"
#include "sim/render/reference/zoomed_tile.hpp"

namespace pitviper {

ReferenceDrawer::ReferenceDrawer(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene,
                                 bool truth, double apertureArea_m2)
    : simulation_(simulation),
      plan_(plan),
      truth_(truth),
      apertureArea_m2_(apertureArea_m2),
      spectra_(std::make_shared<const NodeSpectra>(simulation, plan.nodes, plan.terms)),
      tracer_(simulation, library, std::move(scene)) {}

void ReferenceDrawer::beginPicture(int views) {
  views_ = std::max(views, 1);
  viewsDone_ = 0;
}

void ReferenceDrawer::endPicture() const {
  if (progress_) progress_(1.0);
}

void ReferenceDrawer::draw(const View& view, const WorldState& state, const std::vector<char>& drawn) {
  const SeenLines seen = tracer_.see(view, state, drawn);
  const auto width = static_cast<size_t>(view.width);
  image_ = {};
  image_.width = view.width, image_.height = view.height;
  image_.groups.assign(static_cast<size_t>(plan_.groupCount()), std::vector<float>(4 * seen.solid.size(), 0.0f));
  for (const SeenTriangle& s : seen.solid) image_.entity.push_back(s.entity);
  const ReferenceShader shader(simulation_, plan_, view, state, drawn, spectra_);
  const auto indexOf = [&](int x, int y) { return static_cast<size_t>(y) * width + static_cast<size_t>(x); };
  // The line of a pixel that counts.
  const auto lineAt = [&](int x, int y) -> std::optional<LineOfSight> {
    const size_t p = indexOf(x, y);
    if ((view.onlyEntity >= 0 && seen.solid[p].entity != view.onlyEntity) || (view.wanted && !(*view.wanted)[p])) return {};
    return shader.line(x, y, seen);
  };
  const auto put = [&](int x, int y, const std::vector<double>& slots) {
    for (size_t s = 0; s < slots.size(); ++s) image_.groups[s / 4][4 * indexOf(x, y) + s % 4] = static_cast<float>(slots[s]);
  };
  // A zoomed view of a small body by tiles, a picture by rows.
  const bool zoomed = view.zoomed;
  const int columns = zoomed ? (view.width + ZoomedTile::kSize - 1) / ZoomedTile::kSize : 1;
  const int pieces = zoomed ? columns * ((view.height + ZoomedTile::kSize - 1) / ZoomedTile::kSize) : view.height;
  std::atomic<int> next{0};
  std::mutex meeting;
  auto work = [&](bool tells) {
    NodeSum sum(shader.spectra());
    sum.setOnly(only_);
    if (watches_) sum.watchParts();
    ZoomedTile tile(
        [&](int x, int y) {
          const auto line = lineAt(x, y);
          return line ? shader.looks(*line) : 0;
        },
        [&](int x, int y) { return shader.shadeOver(*lineAt(x, y), x, y, sum).slots; });
    for (int piece = next++; piece < pieces; piece = next++) {
      if (zoomed) {
        const int x = piece % columns * ZoomedTile::kSize, y = piece / columns * ZoomedTile::kSize;
        tile.fill(x, y, std::min(ZoomedTile::kSize, view.width - x), std::min(ZoomedTile::kSize, view.height - y), put);
      } else {
        for (int x = 0; x < view.width; ++x)
          if (const auto line = lineAt(x, piece)) put(x, piece, shader.shadeOver(*line, x, piece, sum).slots);
      }
      // More views than were announced: the picture is as good as done.
      if (tells && progress_) progress_(std::min((viewsDone_ + std::min(1.0, static_cast<double>(next) / pieces)) / views_, 1.0));
    }
    const std::scoped_lock lock(meeting);
    met_.insert(sum.met().begin(), sum.met().end());
  };
  std::vector<std::future<void>> workers;
  for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) workers.push_back(std::async(std::launch::async, work, false));
  work(true);
  for (auto& w : workers) w.get();
  ++viewsDone_;
  if (truth_ && !view.zoomed) tellTruth(view, state, shader, seen);
}

void ReferenceDrawer::tellTruth(const View& view, const WorldState& state, const ReferenceShader& shader, const SeenLines& seen) {
  image_.truth.assign(3, std::vector<float>(4 * seen.solid.size(), 0.0f));
  for (size_t p = 0; p < seen.solid.size(); ++p) {
    const auto x = static_cast<int>(p % static_cast<size_t>(view.width)), y = static_cast<int>(p / static_cast<size_t>(view.width));
    const TruthPixel t = truthOf(simulation_, state, view, shader.line(x, y, seen), apertureArea_m2_, plan_.textureAccuracy, plan_.terms.lights);
    const float layers[3][4] = {{t.area_m2, t.solidAngleFromLight_sr, t.solidAngleOfAperture_sr, t.range_m},
                                {t.normal[0], t.normal[1], t.normal[2], t.temperature_K},
                                {t.entity, t.part, t.cosView, 0.0f}};
    for (size_t l = 0; l < 3; ++l) std::copy_n(layers[l], 4, &image_.truth[l][4 * p]);
  }
}

}  // namespace pitviper
