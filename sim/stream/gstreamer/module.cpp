// The module's border: one C function, no exceptions out.
#include <exception>

#include "sim/stream/gstreamer/gstreamer_module.hpp"
#include "sim/stream/gstreamer/running_pipeline.hpp"

extern "C" __attribute__((visibility("default"))) void pitviperOpenGreyPipeline(const pitviper::GreyPipelineRequest* request,
                                                                                pitviper::GreyPipelineReply* reply) {
  try {
    reply->pipeline = std::make_unique<pitviper::RunningPipeline>(*request);
  } catch (const pitviper::PipelineFailure& failure) {
    reply->failure = failure.what();
    reply->fix = failure.fix();
  } catch (const std::exception& problem) {
    reply->failure = problem.what();
  }
}
