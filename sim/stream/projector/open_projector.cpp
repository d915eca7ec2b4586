#include "sim/stream/projector/open_projector.hpp"

#include <stdexcept>

#include "sim/parameters/module_on_demand.hpp"

namespace pitviper {

std::unique_ptr<Projector> openProjector(const ProjectorOptions& options) {
  if (options.width < 1 || options.height < 1 || options.scale < 1 || options.levels.size() > 65536) throw std::invalid_argument("no frames for a projector");
  const auto open = reinterpret_cast<ProjectorFunction>(
      loadOnDemand({kProjectorModule, kProjectorFunction, "the module", "GLFW and Xlib",
                    "install the packages libglfw3-dev, libx11-dev and libepoxy-dev and build again", "install the packages libglfw3, libx11-6 and libepoxy0"},
                   {"projector"}));
  ProjectorReply reply;
  open(&options, &reply);
  if (!reply.projector) throw UserError({"projector"}, reply.failure, reply.expected, reply.fix);
  return std::move(reply.projector);
}

}  // namespace pitviper
