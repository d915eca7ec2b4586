#include <algorithm>
#include <atomic>

#include "sim/parameters/print.hpp"
#include "sim/stream/pipeline_sinks.hpp"
#include "sim/stream/projector/open_projector.hpp"
#include "sim/stream/stream_picture.hpp"

namespace pitviper {
namespace {

/// A display that shows nothing for so long is gone.
constexpr std::int64_t kLongest_ns = 2000000000;

class WindowSink final : public ProjectorSink {
 public:
  WindowSink(const Camera& camera, const ProjectorWish& wish) : camera_(camera.name), wish_(wish), coder_(camera, "", {}, {"--projector", 0, 0, -1}) {}
  void start() override { projector_ = openProjector({coder_.width(), coder_.height(), wish_.monitor, 1, levelsOfCodes()}); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    if (frame->camera != camera_ || !frame->kind.empty()) return;
    ++taken_;
    if (projector_->closed()) return;
    coder_.code(*frame, picture_);
    projector_->show(picture_.codes, frame->stamp ? frame->stamp->sequence : static_cast<std::uint64_t>(frame->number));
  }
  void finish(const std::function<void(double)>&) override {
    ProjectorSwap swap;
    projector_->waitSwap(swap, kLongest_ns);  // the last frame is seen
  }
  bool neverWaits() const override { return true; }
  std::vector<SinkCounts> counts() const override {
    if (!projector_) return {{"projector", 0, 0, 0, {}}};
    const ProjectorCounts c = projector_->counts();
    const std::uint64_t taken = taken_;
    return {{print("projector at %.2f Hz%s", projector_->rate_hz(), projector_->isPaced() ? " (by a timer: this display holds no swap)" : ""),
             taken,
             c.shown,
             taken - std::min(taken, c.shown),
             {{"swaps", c.swaps}}}};
  }
  std::optional<std::int64_t> nextSwap() override {
    if (!projector_->waitSwap(swap_, kLongest_ns)) return std::nullopt;
    return swap_.time_ns;
  }

 private:
  /// The wish's levels are spread over all codes.
  std::vector<std::uint8_t> levelsOfCodes() const {
    std::vector<std::uint8_t> levels;
    const std::size_t codes = std::size_t{1} << coder_.bits();
    for (std::size_t code = 0; code < codes && !wish_.levels.empty(); ++code) levels.push_back(wish_.levels[code * wish_.levels.size() / codes]);
    return levels;
  }
  std::string camera_;
  ProjectorWish wish_;
  StreamCoder coder_;
  StreamPicture picture_;
  std::unique_ptr<Projector> projector_;
  ProjectorSwap swap_;
  std::atomic<std::uint64_t> taken_{0};
};

}  // namespace

std::unique_ptr<ProjectorSink> makeProjectorSink(const Simulation&, const Camera& camera, const ProjectorWish& wish) {
  return std::make_unique<WindowSink>(camera, wish);
}

}  // namespace pitviper
