#include "sim/render/reference/reference_pass.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <mutex>
#include <optional>
#include <thread>

#include "sim/render/reference/reference_pixel.hpp"
#include "sim/render/reference/zoomed_tile.hpp"

namespace pitviper {

ReferencePass::ReferencePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
                             double apertureArea_m2)
    : ScenePass(simulation, plan, library, std::move(scene), truth, apertureArea_m2, Shading::Reference, false),
      simulation_(simulation),
      spectra_(std::make_shared<const NodeSpectra>(simulation, plan.nodes, plan.terms.surroundings)) {
  if (!truth) return;
  ShaderSlots slots = shadingSlots(false);
  slots.generated["weights"] = "";
  slots.files["truth"] = "sim/render/glsl/truth_layers.glsl";
  slots.generated["targets"] = "void clearTargets() {}\n";
  slots.generated["integrate"] = "void integrate() {}\n";
  truthProgram_ = ShadingProgram(library, slots, truthTargets(), static_cast<size_t>(plan.groupCount()));
}

void ReferencePass::beginPicture(int views) {
  views_ = std::max(views, 1);
  viewsDone_ = 0;
}

void ReferencePass::endPicture() const {
  if (progress_) progress_(1.0);
}

void ReferencePass::beforeShading(const View& view, const WorldState& state, const std::vector<char>& drawn) {
  view_ = view;
  state_ = state;
  drawn_ = drawn;
}

void ReferencePass::shade(RenderTarget& into, const RenderTarget& visibility) {
  Readback readback;
  readback.start(into, 0, &visibility);
  const auto identity = readback.wait().identity;
  const int width = visibility.width(), height = visibility.height();
  const size_t groups = static_cast<size_t>(plan().groupCount());
  std::vector<std::vector<float>> channels(groups, std::vector<float>(4 * static_cast<size_t>(width) * static_cast<size_t>(height), 0.0f));
  const ReferenceShader shader(simulation_, plan(), view_, state_, drawn_, spectra_);
  // The line of a pixel that counts.
  const auto lineAt = [&](int x, int y) -> std::optional<LineOfSight> {
    const size_t p = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    const DrawItem& item = tables().draws[identity[2 * p]];
    if (view_.onlyEntity >= 0 && item.entity != view_.onlyEntity) return {};
    if (view_.wanted && !(*view_.wanted)[p]) return {};
    SeenTriangle seen;
    if (item.entity >= 0) seen = {item.entity, identity[2 * p + 1] - sharedScene()->firstTriangle(item.entity)};
    return shader.line(x, y, seen);
  };
  const auto put = [&](int x, int y, const std::vector<double>& slots) {
    const size_t p = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    for (size_t s = 0; s < slots.size(); ++s) channels[s / 4][4 * p + s % 4] = static_cast<float>(slots[s]);
  };
  // A zoomed view of a small body by tiles, a picture by rows.
  const bool zoomed = view_.zoomed;
  const int columns = zoomed ? (width + ZoomedTile::kSize - 1) / ZoomedTile::kSize : 1;
  const int pieces = zoomed ? columns * ((height + ZoomedTile::kSize - 1) / ZoomedTile::kSize) : height;
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
        tile.fill(x, y, std::min(ZoomedTile::kSize, width - x), std::min(ZoomedTile::kSize, height - y), put);
      } else {
        for (int x = 0; x < width; ++x)
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
  for (size_t g = 0; g < groups; ++g) glTextureSubImage2D(into.colour(g).name(), 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, channels[g].data());
  if (hasTruth()) truthProgram_.run(into, pixelClasses().all());
}

}  // namespace pitviper
