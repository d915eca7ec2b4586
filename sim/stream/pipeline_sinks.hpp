#pragma once
// Sinks that the command line alone asks for: a scenario from elsewhere is not to start programs, nor to cover a screen.
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// Frames of a camera into a GStreamer pipeline. Errors: UserError.
std::unique_ptr<Sink> makeGstreamerSink(const Simulation& simulation, const Camera& camera, const std::string& pipeline);

struct ProjectorWish {
  int monitor = -1;                  ///< the one to fill, from 0; -1: a window
  std::vector<std::uint8_t> levels;  ///< of codes, evenly over all of them: what is sent to the screen; empty: 16 bits in red (high) and green (low)
};
/// Frames of a camera in a window, one pixel a pixel. Errors: UserError.
class ProjectorSink : public Sink {
 public:
  /// Waits for the screen's next picture: when it came; none where the window was closed.
  virtual std::optional<std::int64_t> nextSwap() = 0;
};
std::unique_ptr<ProjectorSink> makeProjectorSink(const Simulation& simulation, const Camera& camera, const ProjectorWish& wish);

}  // namespace pitviper
