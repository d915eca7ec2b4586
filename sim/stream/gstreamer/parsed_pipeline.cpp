#include "sim/stream/gstreamer/parsed_pipeline.hpp"

#include <bit>

namespace pitviper {
namespace {

// Frames are handed over as they lie in memory.
static_assert(std::endian::native == std::endian::little);
constexpr GstVideoFormat kFormat = GST_VIDEO_FORMAT_GRAY16_LE;
constexpr const char* kSource = "pitviper";

struct FreeText {
  void operator()(gpointer text) const { g_free(text); }
};
using Text = std::unique_ptr<gchar, FreeText>;

std::string take(GError* error) {
  const std::string message = oneLine(error->message);
  g_error_free(error);
  return message;
}

GstVideoInfo describe(const GreyPipelineRequest& request) {
  GstVideoInfo info;
  if (!gst_video_info_set_format(&info, kFormat, static_cast<guint>(request.width), static_cast<guint>(request.height)))
    throw PipelineFailure("GStreamer has no frames of " + std::to_string(request.width) + " x " + std::to_string(request.height) + " pixels",
                          "make them smaller");
  gst_util_double_to_fraction(request.rate_hz, &info.fps_n, &info.fps_d);
  if (info.fps_n < 1) info.fps_n = 1, info.fps_d = G_MAXINT;  // slower than a fraction can say
  return info;
}

/// Live: sinks do not wait for a first frame, and the source tells them so. The queue is watched by us: full, it must neither hold a frame back nor drop one
/// unseen. The filter behind it has what follows checked for its pixels now, which a source alone has done by its first frame.
std::string sourceText(const GstVideoInfo& frames) {
  const std::unique_ptr<GstCaps, void (*)(GstCaps*)> caps(gst_video_info_to_caps(&frames), gst_caps_unref);
  const std::string quoted = std::string(" caps=\"") + Text(gst_caps_to_string(caps.get())).get() + "\"";
  return std::string("appsrc name=") + kSource + quoted +
         " format=time is-live=true block=false max-bytes=0 max-buffers=0 max-time=0 ! capsfilter name=frames" + quoted + " ! ";
}

std::string fixFor(const GError& error) {
  if (g_error_matches(&error, GST_PARSE_ERROR, GST_PARSE_ERROR_NO_SUCH_ELEMENT))
    return "check its name with gst-inspect-1.0, or install the package that has it: gstreamer1.0-plugins-base, -good, -bad, -ugly, gstreamer1.0-libav";
  if (g_error_matches(&error, GST_PARSE_ERROR, GST_PARSE_ERROR_LINK)) return "put videoconvert between elements that want different pixels";
  if (g_error_matches(&error, GST_PARSE_ERROR, GST_PARSE_ERROR_NO_SUCH_PROPERTY)) return "see the element's properties with gst-inspect-1.0";
  return "try the text with gst-launch-1.0, behind 'videotestsrc !'";
}

/// Its frames would have nowhere to go, which ends a pipeline at its first. Elements inside of bins are those bins' business.
void checkLinked(GstElement* pipeline) {
  std::string open;
  std::unique_ptr<GstIterator, void (*)(GstIterator*)> elements(gst_bin_iterate_elements(GST_BIN(pipeline)), gst_iterator_free);
  const auto look = [](const GValue* item, gpointer found) {
    const auto note = [](GstElement* element, GstPad* pad, gpointer name) -> gboolean {
      if (!gst_pad_is_linked(pad)) *static_cast<std::string*>(name) = Text(gst_object_get_name(GST_OBJECT(element))).get();
      return TRUE;
    };
    gst_element_foreach_src_pad(GST_ELEMENT(g_value_get_object(item)), note, found);
  };
  gst_iterator_foreach(elements.get(), look, &open);
  if (!open.empty()) throw PipelineFailure("nothing takes what '" + open + "' gives", "end the text with a sink: '... ! filesink location=frames.raw'");
}

}  // namespace

std::string oneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

void loadGstreamer() {
  gst_segtrap_set_enabled(FALSE);  // else SIGSEGV is GStreamer's while it loads plugins
  GError* error = nullptr;
  if (!gst_init_check(nullptr, nullptr, &error))
    throw PipelineFailure("GStreamer cannot start" + (error != nullptr ? " (" + take(error) + ")" : std::string()), "reinstall libgstreamer1.0-0");
}

ParsedPipeline parsePipeline(const GreyPipelineRequest& request) {
  if (request.text.find_first_not_of(" \t\r\n") == std::string::npos) throw PipelineFailure("the text is empty", "write '... ! filesink location=frames.raw'");
  ParsedPipeline parsed;
  parsed.frames = describe(request);
  GError* error = nullptr;
  GstElement* made = gst_parse_launch_full((sourceText(parsed.frames) + request.text).c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error);
  if (made != nullptr) parsed.pipeline.reset(GST_ELEMENT(gst_object_ref_sink(made)));
  if (error != nullptr) {
    const std::string fix = fixFor(*error);
    throw PipelineFailure(take(error), fix);
  }
  if (made == nullptr || !GST_IS_PIPELINE(made)) throw PipelineFailure("this is no pipeline", "try it with gst-launch-1.0, behind 'videotestsrc !'");
  parsed.source.reset(GST_APP_SRC(gst_bin_get_by_name(GST_BIN(made), kSource)));
  parsed.bus.reset(gst_element_get_bus(made));
  checkLinked(made);
  return parsed;
}

}  // namespace pitviper
