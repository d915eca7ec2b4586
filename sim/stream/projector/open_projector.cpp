#include "sim/stream/projector/open_projector.hpp"

#include <stdexcept>

#include "sim/parameters/error.hpp"
#include "sim/stream/on_demand/on_demand.hpp"

namespace pitviper {

std::unique_ptr<Projector> openProjector(const ProjectorOptions& options) {
  if (options.width < 1 || options.height < 1 || options.scale < 1 || options.levels.size() > 65536) throw std::invalid_argument("no frames for a projector");
  const auto open = reinterpret_cast<ProjectorFunction>(loadOnDemand(
      {"projector", kProjectorModule, kProjectorFunction, "GLFW and Xlib", "libglfw3, libx11-6 and libepoxy0", "libglfw3-dev, libx11-dev and libepoxy-dev"}));
  ProjectorReply reply;
  open(&options, &reply);
  if (!reply.projector) throw UserError({"projector"}, reply.failure, reply.expected, reply.fix);
  return std::move(reply.projector);
}

}  // namespace pitviper
