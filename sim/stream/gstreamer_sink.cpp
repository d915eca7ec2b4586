#include <atomic>

#include "sim/stream/gstreamer/open_grey_pipeline.hpp"
#include "sim/stream/pipeline_sinks.hpp"
#include "sim/stream/stream_picture.hpp"

namespace pitviper {
namespace {

class GstreamerSink final : public Sink {
 public:
  GstreamerSink(const Simulation& simulation, const Camera& camera, std::string pipeline)
      : camera_(camera.name), text_(std::move(pipeline)), rate_hz_(1.0 / simulation.time.step_s), coder_(camera, "", {}, {"--gstreamer", 0, 0, -1}) {}
  void start() override { pipeline_ = openGreyPipeline(text_, coder_.width(), coder_.height(), rate_hz_); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    if (frame->camera != camera_ || !frame->kind.empty()) return;
    ++taken_;
    coder_.code(*frame, picture_);
    pipeline_->push(picture_.codes, frame->stamp ? frame->stamp->time_ns : static_cast<std::int64_t>(1e9 * frame->time_s));
  }
  void finish(const std::function<void(double)>&) override {
    pipeline_->finish();
    if (const std::string error = pipeline_->error(); !error.empty()) failure_ = error;
  }
  bool neverWaits() const override { return true; }
  std::vector<SinkCounts> counts() const override {
    const GreyPipelineCounts c = pipeline_ ? pipeline_->counts() : GreyPipelineCounts{};
    return {{"GStreamer " + text_.substr(0, 60) + (failure_.empty() ? "" : " (" + failure_ + ")"), taken_, c.taken, c.skipped, {}}};
  }

 private:
  std::string camera_, text_, failure_;
  double rate_hz_;
  StreamCoder coder_;
  StreamPicture picture_;
  std::unique_ptr<GreyPipeline> pipeline_;
  std::atomic<std::uint64_t> taken_{0};
};

}  // namespace

std::unique_ptr<Sink> makeGstreamerSink(const Simulation& simulation, const Camera& camera, const std::string& pipeline) {
  return std::make_unique<GstreamerSink>(simulation, camera, pipeline);
}

}  // namespace pitviper
