#pragma once
// The loop: advance, render, frame, hand over.
#include <functional>
#include <map>
#include <memory>

#include "sim/camera/audit.hpp"
#include "sim/frame/frame.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

struct RunRange {
  int first = 0, last = 0;  ///< frame numbers, both included
  bool drafts =
      false;  ///< frames are drawn by drafts (kDraft) while plans are made beside, of all cameras, and by those from the frame on at which they are there
};

/// Called for every frame, as of Sink::take().
using FrameTaker = std::function<void(const std::shared_ptr<const Frame>&)>;
struct ProbeReading {
  const Probe& probe;
  int frame;
  double time_s;
  std::vector<double> values;
};
/// Called on the drawing thread while something takes long: with the share that is done of a picture (reference mode), or of a camera's plan.
struct RunProgress {
  std::function<void(double share)> picture;
  std::function<void(const Camera& camera, double share)> planning;  ///< 1: made
  /// Every frame of a camera's channels, with the world of its tick and where the camera looked: before it is handed over.
  std::function<void(const Camera& camera, const Frame& frame, const WorldState& world, const Pose& pose)> drawn = {};
};
using ProbeSink = std::function<void(const ProbeReading&)>;

/// What audits found, by camera.
struct RunReport {
  std::map<std::string, std::vector<FilmPlace>> broken;  ///< where it was more than was asked
  std::map<std::string, AuditTally> audits;
  std::map<std::string, std::string> poses;  ///< of each camera with a follower the record: from the scenario's first frame on
  std::map<std::string, std::string> plans;  ///< text of each camera's plan (Camera::plan); none in reference mode, or of a draft
  int drafts = 0;                            ///< frames of each camera that were drawn by one
  std::string whyDrafts;                     ///< why all were, where the driver could not make what was asked for
};

/// Parts of a run's time (sim/gl/timing.hpp) that no later frame takes: what comes before the first frame, and that frame, in which programs are compiled
/// and what stays is made.
inline constexpr const char *kPreparingPart = "preparing", *kFirstFramePart = "first frame";

/// Renders the frames of all cameras, and audits them (Simulation::audit). With `stopsAtBroken` it ends after the first tick in which an audit
/// found more than was asked. While one frame is handed to the sink on a thread of its own, the next is drawn; frames
/// arrive in order, one at a time. An exception of the sink ends the run and is thrown here. Returns what audits found.
RunReport runFrames(const Simulation& simulation, const ShaderLibrary& library, const RunRange& range, const FrameTaker& frames, const ProbeSink& probes = {},
                    const RunProgress& progress = {}, bool stopsAtBroken = false);

}  // namespace pitviper
