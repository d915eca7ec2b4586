#pragma once
// GStreamer for those who are not linked with it.
#include <memory>
#include <string>

#include "sim/stream/gstreamer/gstreamer_module.hpp"

namespace pitviper {

/// Frames of `width` x `height` pixels, `rate_hz` of them a second, go into `pipeline`, a text as for gst-launch-1.0 without a source: "videoconvert ! x264enc
/// ! mp4mux ! filesink location=a.mp4". They are video/x-raw, format=GRAY16_LE, of which rows begin at multiples of 4 bytes. What converts them keeps 16 bits
/// only where the text says so: "videoconvert ! video/x-raw,format=GRAY16_BE ! pngenc ! ...". Sinks that keep time (`sync=true`) keep the frames': a run that
/// is faster or slower wants `sync=false`. Sinks are open when it returns, or wait for a reader, then two seconds later. Errors: UserError, with what GStreamer
/// says of the text or of a sink that cannot be opened; and where it or the module is not installed.
std::unique_ptr<GreyPipeline> openGreyPipeline(const std::string& pipeline, int width, int height, double rate_hz);

}  // namespace pitviper
