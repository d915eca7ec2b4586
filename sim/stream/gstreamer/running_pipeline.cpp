#include "sim/stream/gstreamer/running_pipeline.hpp"

#include <condition_variable>
#include <cstring>
#include <mutex>

namespace pitviper {
namespace {

/// Frames that wait in front of the pipeline: enough for an encoder that stops for a moment. A `queue` in the text makes room for more.
constexpr guint64 kQueue = 4;

/// How long an opened sink is waited for: a file or a socket takes none of it, a named pipe opens when a reader comes.
constexpr std::chrono::seconds kOpening{2};

/// For encoders that hold back dozens of frames; and what users bear.
constexpr std::chrono::seconds kFinishing{10};

/// Keeps signals from the pipeline's threads, as each begins, and from the bus what nobody would read.
GstBusSyncReply sift(GstBus*, GstMessage* message, gpointer) {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_STREAM_STATUS) {
    GstStreamStatusType status{};
    gst_message_parse_stream_status(message, &status, nullptr);
    if (status == GST_STREAM_STATUS_TYPE_ENTER) blockSignals();
  }
  constexpr int kRead = GST_MESSAGE_ERROR | GST_MESSAGE_EOS | GST_MESSAGE_LATENCY | GST_MESSAGE_CLOCK_LOST | GST_MESSAGE_APPLICATION;
  if ((GST_MESSAGE_TYPE(message) & kRead) != 0) return GST_BUS_PASS;
  gst_message_unref(message);
  return GST_BUS_DROP;
}

/// "filesink0: Could not open ... (system error: ...)": the last line of what GStreamer adds is the reason, those before are places in its source.
std::string textOf(GstMessage* message) {
  GError* error = nullptr;
  gchar* added = nullptr;
  gst_message_parse_error(message, &error, &added);
  std::string text = std::string(GST_OBJECT_NAME(message->src)) + ": " + error->message;
  const std::string more = added != nullptr ? added : "";
  if (const size_t line = more.rfind('\n'); line != std::string::npos) text += " (" + more.substr(line + 1) + ")";
  g_error_free(error);
  g_free(added);
  return oneLine(text);
}

using Message = std::unique_ptr<GstMessage, void (*)(GstMessage*)>;

Message nextMessage(GstBus* bus, GstClockTime patience) { return {gst_bus_timed_pop(bus, patience), gst_message_unref}; }

}  // namespace

/// What the controlling thread, which may be left behind, and its owner both use.
struct RunningPipeline::Shared {
  enum class Phase { Parsing, Opening, Open, Over };

  GreyPipelineRequest request;
  ParsedPipeline parsed;  ///< constant after Parsing
  std::atomic<bool> takes = false, stop = false;

  std::mutex mutex;
  std::condition_variable changed;
  Phase phase = Phase::Parsing;
  std::optional<PipelineFailure> failure;  ///< before Open
  std::string error;

  void enter(Phase next) {
    const std::lock_guard lock(mutex);
    phase = next;
    changed.notify_all();
  }
  template <class Duration>
  bool isOverWithin(Duration patience) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, patience, [&] { return phase == Phase::Over; });
  }
  void note(const std::string& text) {
    const std::lock_guard lock(mutex);
    if (error.empty()) error = text;  // the first is the cause of others
  }
  /// The controlling thread, which waits on the bus: there is a first frame, or it shall stop.
  void wake() const { gst_bus_post(parsed.bus.get(), gst_message_new_application(GST_OBJECT(parsed.pipeline.get()), gst_structure_new_empty("pitviper"))); }
  void askToStop() {
    takes = false;
    stop = true;
    wake();
  }
};

namespace {

/// Why it does not open; empty: it does. Not every element that fails fails the change of state, but it says so.
std::string open(GstElement* pipeline, GstBus* bus) {
  const bool changes = gst_element_set_state(pipeline, GST_STATE_PAUSED) != GST_STATE_CHANGE_FAILURE;
  while (const Message message = nextMessage(bus, 0))
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR) return textOf(message.get());
  return changes ? "" : "an element cannot be opened";
}

/// Until the end of the stream, an error or a wish to stop; returns the error.
std::string watch(GstElement* pipeline, GstBus* bus, const std::atomic<bool>& stop) {
  while (!stop) {
    const Message message = nextMessage(bus, GST_CLOCK_TIME_NONE);
    switch (GST_MESSAGE_TYPE(message.get())) {
      case GST_MESSAGE_ERROR:
        return textOf(message.get());
      case GST_MESSAGE_EOS:
        return {};
      case GST_MESSAGE_LATENCY:
        gst_bin_recalculate_latency(GST_BIN(pipeline));
        break;
      case GST_MESSAGE_CLOCK_LOST:  // another is chosen on the way back
        gst_element_set_state(pipeline, GST_STATE_PAUSED);
        gst_element_set_state(pipeline, GST_STATE_PLAYING);
        break;
      case GST_MESSAGE_APPLICATION:
        if (!stop) gst_element_set_state(pipeline, GST_STATE_PLAYING);  // the first frame; a failure comes as an error
        break;
      default:
        break;
    }
  }
  return {};
}

}  // namespace

void RunningPipeline::control(Shared& shared) {
  try {
    loadGstreamer();
    shared.parsed = parsePipeline(shared.request);
  } catch (const PipelineFailure& failure) {
    shared.failure = failure;
  } catch (const std::exception& problem) {
    shared.failure = PipelineFailure(problem.what(), "");
  }
  if (shared.failure) return shared.enter(Shared::Phase::Over);
  GstElement* pipeline = shared.parsed.pipeline.get();
  GstBus* bus = shared.parsed.bus.get();
  gst_bus_set_sync_handler(bus, sift, nullptr, nullptr);
  shared.enter(Shared::Phase::Opening);
  std::string reason = open(pipeline, bus);
  if (reason.empty()) {
    shared.takes = !shared.stop;
    shared.enter(Shared::Phase::Open);
    reason = watch(pipeline, bus, shared.stop);
    shared.takes = false;
  } else {
    shared.failure = PipelineFailure(reason, "correct what the text says of it");
  }
  if (!reason.empty()) shared.note(reason);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  shared.enter(Shared::Phase::Over);
}

RunningPipeline::RunningPipeline(const GreyPipelineRequest& request)
    : shared_(std::make_shared<Shared>()), thread_([shared = shared_, request] {
        shared->request = request;
        control(*shared);
      }) {
  std::unique_lock lock(shared_->mutex);
  // GStreamer's first start looks through all its plugins.
  shared_->changed.wait(lock, [&] { return shared_->phase != Shared::Phase::Parsing; });
  shared_->changed.wait_for(lock, kOpening, [&] { return shared_->phase != Shared::Phase::Opening; });
  if (shared_->phase == Shared::Phase::Over && shared_->failure) throw PipelineFailure(*shared_->failure);
}

RunningPipeline::~RunningPipeline() { shared_->askToStop(); }

GstBuffer* RunningPipeline::bufferOf(std::span<const std::uint16_t> codes, std::int64_t time_ns) const {
  const GstVideoInfo& frames = shared_->parsed.frames;
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&frames), nullptr);
  GstMapInfo memory;
  if (buffer == nullptr || !gst_buffer_map(buffer, &memory, GST_MAP_WRITE)) {
    if (buffer != nullptr) gst_buffer_unref(buffer);
    return nullptr;
  }
  const size_t width = static_cast<size_t>(frames.width), stride = static_cast<size_t>(GST_VIDEO_INFO_PLANE_STRIDE(&frames, 0)), row = width * sizeof(codes[0]);
  for (size_t y = 0; y < static_cast<size_t>(frames.height); ++y) {
    std::memcpy(memory.data + y * stride, codes.data() + y * width, row);
    std::memset(memory.data + y * stride + row, 0, stride - row);
  }
  gst_buffer_unmap(buffer, &memory);
  GST_BUFFER_PTS(buffer) = static_cast<GstClockTime>(std::max<std::int64_t>(0, time_ns - first_ns_.value_or(time_ns)));
  GST_BUFFER_DURATION(buffer) = gst_util_uint64_scale_int(GST_SECOND, frames.fps_d, frames.fps_n);
  return buffer;
}

bool RunningPipeline::push(std::span<const std::uint16_t> codes, std::int64_t time_ns) {
  const GreyPipelineRequest& request = shared_->request;
  if (codes.size() != static_cast<size_t>(request.width) * static_cast<size_t>(request.height)) throw std::invalid_argument("a frame of another size");
  GstAppSrc* source = shared_->parsed.source.get();
  GstBuffer* buffer = shared_->takes && gst_app_src_get_current_level_buffers(source) < kQueue ? bufferOf(codes, time_ns) : nullptr;
  if (buffer == nullptr || gst_app_src_push_buffer(source, buffer) != GST_FLOW_OK) {
    ++skipped_;
    return false;
  }
  ++taken_;
  if (!first_ns_) {
    first_ns_ = time_ns;
    shared_->wake();
  }
  return true;
}

std::string RunningPipeline::error() {
  const std::lock_guard lock(shared_->mutex);
  return shared_->error;
}

bool RunningPipeline::hasEnded() {
  const std::lock_guard lock(shared_->mutex);
  return shared_->phase == Shared::Phase::Over;
}

void RunningPipeline::finish() {
  shared_->takes = false;
  if (taken_ > 0) {
    gst_app_src_end_of_stream(shared_->parsed.source.get());
    if (shared_->isOverWithin(kFinishing)) return;
    shared_->note("the pipeline did not end within " + std::to_string(kFinishing.count()) + " s: its files may not be whole");
  }
  shared_->askToStop();
}

}  // namespace pitviper
