#pragma once
// The border between the program and the GStreamer module: one C function. Both sides come from one build, so that C++ types may cross it.
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace pitviper {

struct GreyPipelineCounts {
  std::uint64_t taken = 0;    ///< frames that the pipeline's queue took
  std::uint64_t skipped = 0;  ///< frames that it did not
};

/// 16-bit grey frames into a GStreamer pipeline. Used from one thread at a time; nothing but finish() and the destructor ever waits.
class GreyPipeline {
 public:
  /// Without finish() before, files are left as they are, mostly not whole. Waits at most two seconds; a sink that hangs longer is left behind.
  virtual ~GreyPipeline() = default;

  /// `codes`: width x height, row by row from the top. `time_ns`: the frame's, not decreasing; the first frame that is taken is at 0 in the pipeline, and
  /// starts its clock. False, and skipped, where the queue is full, the pipeline's sinks are not open yet, or it has ended. Errors: std::invalid_argument for
  /// another number of codes.
  virtual bool push(std::span<const std::uint16_t> codes, std::int64_t time_ns) = 0;
  /// What went wrong in the pipeline, in one line; empty: nothing.
  virtual std::string error() = 0;
  /// Whether it is over: it failed, was ended by its own elements, or finished; its files are closed.
  virtual bool hasEnded() = 0;
  /// End of stream: what was taken goes through, files are made whole. Waits at most ten seconds for that; error() says where it was not enough.
  virtual void finish() = 0;
  virtual GreyPipelineCounts counts() const = 0;
};

struct GreyPipelineRequest {
  std::string text;  ///< as for gst-launch-1.0, without a source
  int width = 0, height = 0;
  double rate_hz = 0.0;
};

struct GreyPipelineReply {
  std::unique_ptr<GreyPipeline> pipeline;
  std::string failure;  ///< why there is none, in one line
  std::string fix;
};

inline constexpr const char* kGstreamerModule = "libpitviper_gstreamer.so";
inline constexpr const char* kGstreamerFunction = "pitviperOpenGreyPipeline";
using GstreamerFunction = void (*)(const GreyPipelineRequest* request, GreyPipelineReply* reply);

}  // namespace pitviper
