#include "sim/stream/gstreamer/open_grey_pipeline.hpp"

#include <cmath>
#include <stdexcept>

#include "sim/parameters/module_on_demand.hpp"

namespace pitviper {

std::unique_ptr<GreyPipeline> openGreyPipeline(const std::string& pipeline, int width, int height, double rate_hz) {
  if (width < 1 || height < 1 || !std::isfinite(rate_hz) || rate_hz <= 0.0) throw std::invalid_argument("no frames for a pipeline");
  const auto open =
      reinterpret_cast<GstreamerFunction>(loadOnDemand({kGstreamerModule, kGstreamerFunction, "the module", "GStreamer 1.20 or later",
                                                        "install the packages libgstreamer1.0-dev and libgstreamer-plugins-base1.0-dev and build again",
                                                        "install the packages libgstreamer1.0-0 and libgstreamer-plugins-base1.0-0"},
                                                       {"pipeline"}));
  const GreyPipelineRequest request{pipeline, width, height, rate_hz};
  GreyPipelineReply reply;
  open(&request, &reply);
  if (!reply.pipeline) throw UserError({"pipeline"}, reply.failure, "a text as for gst-launch-1.0, without a source", reply.fix);
  return std::move(reply.pipeline);
}

}  // namespace pitviper
