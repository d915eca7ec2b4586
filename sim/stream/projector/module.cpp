// The module's border: one C function, no exceptions out.
#include <exception>

#include "sim/stream/projector/projector_failure.hpp"
#include "sim/stream/projector/projector_module.hpp"
#include "sim/stream/projector/window_projector.hpp"

extern "C" __attribute__((visibility("default"))) void pitviperOpenProjector(const pitviper::ProjectorOptions* options, pitviper::ProjectorReply* reply) {
  try {
    reply->projector = std::make_unique<pitviper::WindowProjector>(*options);
  } catch (const pitviper::ProjectorFailure& failure) {
    reply->failure = failure.what();
    reply->expected = failure.expected;
    reply->fix = failure.fix;
  } catch (const std::exception& problem) {
    reply->failure = problem.what();
  }
}
