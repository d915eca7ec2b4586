#pragma once
// A pipeline made of its text, with our source in front, not yet running.
#include <gst/app/gstappsrc.h>
#include <gst/gst.h>
#include <gst/video/video.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "sim/stream/gstreamer/gstreamer_module.hpp"

namespace pitviper {

/// The user's mistake, and what to do.
class PipelineFailure : public std::runtime_error {
 public:
  PipelineFailure(const std::string& wrong, std::string fix) : std::runtime_error(wrong), fix_(std::move(fix)) {}
  const std::string& fix() const { return fix_; }

 private:
  std::string fix_;
};

struct Unref {
  void operator()(gpointer object) const { gst_object_unref(object); }
};

struct ParsedPipeline {
  std::unique_ptr<GstElement, Unref> pipeline;
  std::unique_ptr<GstAppSrc, Unref> source;
  std::unique_ptr<GstBus, Unref> bus;
  GstVideoInfo frames{};
};

/// In one line.
std::string oneLine(std::string text);

/// Loads GStreamer, which leaves signals, arguments and the output alone. Throws PipelineFailure.
void loadGstreamer();

/// Throws PipelineFailure for an unknown element or property, and for elements that do not go together.
ParsedPipeline parsePipeline(const GreyPipelineRequest& request);

}  // namespace pitviper
