#pragma once
// The loop: advance, render, frame, hand over.
#include <functional>

#include "sim/frame/frame.hpp"

namespace pitviper {

struct RunRange {
  int first = 0, last = 0;  ///< frame numbers, both included
};

/// Called for every frame in order: a camera's frame, its spectral image if it has one, camera by camera, then tick by tick.
using FrameSink = std::function<void(const Frame&)>;
struct ProbeReading {
  const Probe& probe;
  int frame;
  double time_s;
  std::vector<double> values;
};
/// Called on the drawing thread while a picture takes long (reference mode): the share of it that is done.
using PictureProgress = std::function<void(double share)>;
using ProbeSink = std::function<void(const ProbeReading&)>;

/// Renders the frames of all cameras. While one frame is handed to the sink on a thread of its own, the next is drawn; frames
/// arrive in order, one at a time. An exception of the sink ends the run and is thrown here.
void runFrames(const Simulation& simulation, const ShaderLibrary& library, const RunRange& range, const FrameSink& frames, const ProbeSink& probes = {},
               const PictureProgress& progress = {});

}  // namespace pitviper
