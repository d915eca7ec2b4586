#pragma once
// A pipeline and the thread that starts, watches and stops it.
#include <atomic>
#include <memory>
#include <optional>

#include "sim/stream/gstreamer/gstreamer_module.hpp"
#include "sim/stream/on_demand/own_thread.hpp"
#include "sim/stream/gstreamer/parsed_pipeline.hpp"

namespace pitviper {

class RunningPipeline final : public GreyPipeline {
 public:
  /// Throws PipelineFailure.
  explicit RunningPipeline(const GreyPipelineRequest& request);
  ~RunningPipeline() override;

  bool push(std::span<const std::uint16_t> codes, std::int64_t time_ns) override;
  std::string error() override;
  bool hasEnded() override;
  void finish() override;
  GreyPipelineCounts counts() const override { return {taken_, skipped_}; }

 private:
  struct Shared;
  static void control(Shared& shared);
  GstBuffer* bufferOf(std::span<const std::uint16_t> codes, std::int64_t time_ns) const;

  std::shared_ptr<Shared> shared_;
  std::optional<std::int64_t> first_ns_;
  std::atomic<std::uint64_t> taken_ = 0, skipped_ = 0;
  OwnThread thread_;
};

}  // namespace pitviper
